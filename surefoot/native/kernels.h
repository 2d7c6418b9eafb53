/*
 * What Python and C share: structs of numbers and pointers, and the functions that work on them.
 *
 * `surefoot.native.library` reads this file, so that each struct is told once. Therefore: one field a line, each an
 * int64_t, a double, an array of doubles, or a pointer to double, int64_t or a struct above; functions take one struct
 * pointer, then int64_t or double. Python allocates all memory; matrices lie row by row unless a name says "columns".
 * Sizes come at run time.
 */
#ifndef SUREFOOT_KERNELS_H
#define SUREFOOT_KERNELS_H

#include <stdint.h>

/* Of `wbc.model.RobotTerms`, whose names these are, what kernels read. */
typedef struct {
    int64_t nv;
    double model_mass;
    double wrench_unit;
    const double *angular_momentum;
    const double *bias;
    const double *com;
    const double *com_velocity;
    const double *sole_position;
    const double *sole_rotation;
    const double *sole_wrench_map;
} Terms;

/* Counterpart of `wbc.types.WbcReference`, as far as kernels need it. */
typedef struct {
    double com[3];
    double com_velocity[3];
    double com_acceleration[3];
    double zmp[2];
    double zmp_offset[2];
    double swing_position[3];
    double swing_velocity[3];
    double swing_acceleration[3];
    double swing_angular_velocity[3];
    double swing_angular_acceleration[3];
    double swing_rotation[9];
    double ground_normal[6];
    double omega;
    double stiffness;
    double heading;
    double heading_rate;
    double load_share[2];
    double roll[3];
    double swing_foot;
    double rolling_foot;
    double catching;
} Reference;

/* Of `wbc.tasks.stack.TaskStack`, whose names these are, what kernels read. */
typedef struct {
    int64_t variables;
    int64_t rows_count;
    const double *rows;
    const double *target;
    const double *unscale;
} Stack;

/* Kernels without numbers of their own, one after another: addresses of functions and of their structs. */
typedef struct {
    int64_t count;
    const int64_t *functions;
    const int64_t *structs;
} Calls;

void calls_run(const Calls *calls);

/* Counterpart of `wbc.solvers.equalities_only`; H is split where its first variables do not meet the others. */
typedef struct {
    int64_t variables;
    int64_t equalities;
    int64_t rows;
    const double *H;
    const double *g;
    const double *A;
    const double *lower;
    const double *upper;
    double *factor;
    double *right_sides;
    double *schur;
    double *multipliers;
    double *x;
} EqualityQp;

double equality_qp_solve(const EqualityQp *qp, int64_t split);

/* Counterpart of `wbc.controller.WholeBodyController.interpret`, for a solution whose wrenches are the soles'. */
typedef struct {
    const Terms *terms;
    const Stack *stack;
    int64_t joints;
    const double *torque_rows;
    const double *torque_limit;
    const double *x;
    double *torque;
    double *acceleration;
    double *wrench;
    double *task_error;
} Answer;

void answer_read(const Answer *answer);

/* The QP under its equalities alone, and what its solution means where it violates no more than the accuracy. */
typedef struct {
    const EqualityQp *qp;
    const Answer *answer;
    int64_t split;
    double accuracy;
} QpAnswer;

double qp_answer(const QpAnswer *both);

/* Counterpart of `wbc.external.LoadObserver.update` within a span. */
typedef struct {
    const Terms *terms;
    const double *wrench;
    double *felt;
    double *com;
    double *past;
    int64_t past_count;
    int64_t *newest;
} LoadSums;

void load_sums_add(const LoadSums *sums);

/* A simulated world before and after a step; counterpart of `sim.world._begun` and `_sound`. */
typedef struct {
    int64_t nq;
    int64_t nv;
    int64_t nu;
    const double *qpos;
    const double *qvel;
    const double *qacc;
    const double *torque;
    double *last_qpos;
    double *last_qvel;
    double *pushed;
} WorldStep;

int64_t world_begun(const WorldStep *world);
int64_t world_sound(const WorldStep *world, double most);

/* Counterpart of `sim.sensors.SensorReader._read`; of a pushed robot the contacts are what is left of external forces. */
typedef struct {
    int64_t nq;
    int64_t nv;
    const double *qpos;
    const double *qvel;
    const double *base_acceleration;
    const double *joint_force;
    const double *base_rotation;
    const double *gravity;
    const double *com;
    const double *push;
    const double *left_external;
    const double *right_external;
    const double *left_contact;
    const double *right_contact;
    const double *left_position;
    const double *right_position;
    const double *left_rotation;
    const double *right_rotation;
    double *q;
    double *v;
    double *torque;
    double *accelerometer;
    double *wrench;
    double *pushed;
} Sensors;

void sensors_read(const Sensors *sensors, int64_t is_pushed);

/* Counterpart of `sim.readings.Noise`: rows of so many numbers, of which each tick takes one; none of silent noise. */
typedef struct {
    int64_t size;
    int64_t silent;
    const double *drawn;
} Noise;

/* Counterpart of `sim.readings.Drift`. */
typedef struct {
    const Noise *steps;
    double *value;
} Drift;

/* Rows of noise and of drifts' steps that this tick takes; that of drifts is negative at the first, which has none. */
typedef struct {
    int64_t noise;
    int64_t drift;
} DrawnRows;

/* Counterpart of `sim.readings.Encoders`, whose joints say a position, a torque and perhaps a velocity. */
typedef struct {
    const DrawnRows *drawn;
    int64_t joints;
    int64_t say_velocity;
    double step;
    const double *offset;
    const Noise *noise;
    const Noise *velocity_noise;
    const Noise *torque_noise;
    const double *true_position;
    const double *true_velocity;
    const double *true_torque;
    double *position;
    double *velocity;
    double *torque;
} Encoders;

void encoders_sample(const Encoders *encoders);

/* Counterpart of `sim.imu_motion.ImuChain`; `place` is its lever, `beside` whether a joint is off its body's origin. */
typedef struct {
    int64_t links;
    const int64_t *joint;
    const int64_t *beside;
    const double *rotation;
    const double *lever;
    const double *axis;
    const double *twist;
    const double *square;
    const double *point;
    const double *mount;
    const double *place;
    const double *q;
    const double *v;
} ImuChain;

/* Counterpart of `sim.readings.Imu`; rotation and velocity are those of the tick before. */
typedef struct {
    const DrawnRows *drawn;
    const ImuChain *chain;
    double period;
    double small;
    const double *gravity;
    double *rotation;
    double *velocity;
    const Drift *gyro_bias;
    const Noise *gyro_noise;
    const Drift *force_bias;
    const Noise *force_noise;
    double most_rate;
    double most_force;
    double *rate;
    double *mean_rate;
    double *force;
} Imu;

void imu_sample(const Imu *imu);

/* Counterpart of `sim.readings.Feet`. */
typedef struct {
    const DrawnRows *drawn;
    const Drift *bias;
    const Noise *noise;
    const double *true_wrench;
    double *wrench;
} Feet;

void feet_sample(const Feet *feet);

/* Counterpart of `scenarios.log.rows.RowWriter`; places and records are addresses, strides and lengths bytes. */
typedef struct {
    const double *vectors;
    int64_t vectors_width;
    const double *numbers;
    int64_t numbers_width;
    const int64_t *times;
    const Calls *before;
    double *values;
    int64_t fields;
    const int64_t *first;
    const int64_t *sizes;
    const int64_t *whole;
    const int64_t *places;
    const int64_t *strides;
    int64_t channels;
    const int64_t *records;
    const int64_t *lengths;
    const int64_t *header;
} LogRows;

void log_rows_put(const LogRows *rows, int64_t count, int64_t sequence);

/* Counterpart of `scenarios.log.spec.Template.encode`; places are those of bytes in the message at an address. */
typedef struct {
    int64_t message;
    const double *values;
    int64_t count;
    const int64_t *places;
    const int64_t *picked;
    int64_t stamps;
    const int64_t *stamp_places;
} MessageTemplate;

void template_fill(const MessageTemplate *message, int64_t seconds, int64_t nanos);

/* Arrays that make up a row, by address and length, read where they are. */
typedef struct {
    int64_t count;
    const int64_t *sources;
    const int64_t *sizes;
    int64_t width;
    double *values;
} RowSources;

void log_row_gather(const RowSources *row, int64_t number);

/* Counterpart of `scenarios.record.body.Recorder._derived`, for one row. */
typedef struct {
    int64_t joints;
    double unloaded;
    double second;
    double without;
    const double *wrench;
    const double *soles;
    const double *sole_rotation;
    const double *status;
    const double *upright;
    const double *com;
    const double *com_velocity;
    const double *omega;
    const double *command;
    const double *inverse_limit;
    double *solver;
    double *fallback;
    double *tilt;
    double *dcm;
    double *limit_ratio;
    double *zmp;
    double *normal_force;
    double *cop_left;
    double *cop_right;
} BodyRow;

void body_row_derive(const BodyRow *row);

/* Counterpart of `scenarios.record.estimation._errors`, for one row; rotations lie by columns, soles are poses. */
typedef struct {
    const double *stance;
    const double *com;
    const double *com_velocity;
    const double *base_rotation;
    const double *soles;
    const double *true_com;
    const double *true_com_velocity;
    const double *true_base_rotation;
    const double *true_soles;
    double *com_error;
    double *com_velocity_error;
    double *tilt_error;
    double *sole_height_error;
    double *yaw_error;
    double *place_error;
} EstimationRow;

void estimation_row_derive(const EstimationRow *row);

/* Counterpart of the end of a span in `wbc.external.LoadObserver`. */
typedef struct {
    const LoadSums *sums;
    double weight;
    double span;
    double ticks;
    int64_t spans_count;
    int64_t latest_count;
    double most_share;
    double least_press;
    const double *share_limits;
    const double *kept;
    const double *sudden;
    const double *bound;
    const double *push;
    const double *most_change;
    const int64_t *known;
    int64_t *waits;
    double *momentum;
    double *spans;
    int64_t *filled;
    double *estimate;
} LoadSpan;

void load_moving(const LoadSpan *span);
int64_t load_span_end(const LoadSpan *span, double age);

/* What the planner is told of the feet: counterpart of `RobotTerms.level_soles` and `wbc.zmp.measured_zmp`. */
typedef struct {
    const Terms *terms;
    double unloaded;
    const double *wrench;
    double *level;
    double *yaw;
    double *zmp;
} FeetSeen;

void feet_see(const FeetSeen *feet, double toe);

/* Counterpart of `wbc.solvers.Daqp`, after `equality_qp_solve`; of inequalities no more than `most` are active. */
typedef struct {
    const EqualityQp *qp;
    int64_t most;
    double tolerance;
    double *normals;
    double *columns;
    double *multipliers;
    int64_t *active;
    double *work;
} ActiveQp;

int64_t active_qp_solve(const ActiveQp *solver);
double qp_violation(const EqualityQp *qp);

/*
 * Counterpart of `planner.laws.qp.solve` with its first solver; its fields are those of `planner.laws.qp.Qp`.
 *
 * `tolerance` is that of a bound over 1 and its variable's size, and of a row over the row's. From `factor` on all is
 * scratch: matrices of n rows and columns, `share` of a number a row, `taken` of one a bound and row, `work` of 4 n.
 */
typedef struct {
    int64_t variables;
    int64_t rows;
    double tolerance;
    const double *P;
    const double *q;
    const double *G;
    const double *h;
    const double *lower;
    const double *upper;
    double *x;
    double *factor;
    double *inverse;
    double *rotated;
    double *triangle;
    double *share;
    double *multipliers;
    double *work;
    int64_t *active;
    int64_t *taken;
} BoundedQp;

int64_t bounded_qp_solve(const BoundedQp *qp, int64_t same);


/* State of `wbc.estimation.invariant_filter.InvariantFilter`, as `Doubt` looks at it. */
typedef struct {
    int64_t size;
    const double *R;
    const double *columns;
} Filter;

/* A sole as `SensedBody` sees it: the placement of its joint in Pinocchio's data, and its own in that. */
typedef struct {
    const double *joint_rotation_columns;
    const double *joint_position;
    const double *placement_rotation;
    const double *placement_position;
} SensedSole;

/*
 * Counterpart of `wbc.estimation.torques.TorqueWrench`: Pinocchio's data, of whose M the other triangle is filled, which
 * velocities move the left sole and the right one (1 or 0), which move any, noise, what is observed, and memory in
 * between.
 */
typedef struct {
    int64_t nv;
    int64_t count;
    int64_t held;
    double base_noise;
    double torque_noise;
    double least;
    double *M;
    const double *C_columns;
    const double *gravity;
    const double *joint_jacobian_columns;
    const SensedSole *left;
    const SensedSole *right;
    const int64_t *rows;
    const double *supporting;
    const double *velocity_noise;
    const double *scale;
    const double *v;
    const double *torque;
    double *momentum;
    double *driven;
    double *last_torque;
    double *residual;
    double *noise;
    double *A;
    double *some;
    double *seen;
    double *wrench;
    double *deviation;
} TorqueWrench;

void torque_wrench_update(const TorqueWrench *torques, double span, double share);

/*
 * Counterpart of `wbc.estimation.kinematics.SensedBody`: Pinocchio's data in the axes of the base, where the IMU is in
 * its joint, which joints carry left sole, right sole and IMU (1 or 0), and what follows.
 */
typedef struct {
    int64_t joints;
    int64_t chain_count;
    const int64_t *chain;
    const double *supporting;
    const double *imu_joint_rotation_columns;
    const double *imu_joint_position;
    const double *mount_rotation;
    const double *mount_position;
    const double *mounting;
    const SensedSole *left;
    const SensedSole *right;
    const double *joint_jacobian_columns;
    const double *com;
    const double *com_jacobian_columns;
    double *imu_rotation;
    double *imu_position;
    double *position;
    double *rotation;
    double *jacobian;
} SensedBody;

void sensed_body_update(const SensedBody *body);
void sensed_body_jacobians(const SensedBody *body);

/* Its covariance likewise. */
typedef struct {
    const Filter *filter;
    const double *P;
} Covariance;

/*
 * Counterpart of `wbc.estimation.doubt.Doubt`: lever of the CoM from the stance sole in axes of the IMU, and variances
 * of CoM, soles' heights, one height over the other, tilt of the base, and CoM velocity, shape (11,).
 */
typedef struct {
    const SensedBody *body;
    const Covariance *covariance;
    double encoder_offset;
    double rate_noise;
    double *rows;
    double *lever;
    double *variance;
} Doubt;

void doubt_tell(const Doubt *doubt, int64_t stance, double gyro);

/* Counterpart of `wbc.estimation.joints.JointObserver`; clock: tick, tick of the state, accelerations told so far. */
typedef struct {
    int64_t joints;
    int64_t kept;
    double period;
    double moved;
    double sped;
    int64_t *clock;
    const double *told;
    const double *reading;
    const double *speed;
    double *position;
    double *velocity;
    double *now_position;
    double *now_velocity;
} JointObserver;

void joint_observer_update(const JointObserver *observer, int64_t late, int64_t fresh, int64_t says_velocity);

/* Counterpart of `wbc.estimation.rates.RateFilter`. */
typedef struct {
    double noise;
    double more;
    double impact;
    const double *seen;
    const double *gained;
    double *rate;
    double *variance;
} RateFilter;

void rate_filter_update(const RateFilter *filter, int64_t ticks, int64_t is_planned);

/* Counterpart of `wbc.estimation.contact.SoleContact`; forces that a share of the weight tells are forces here. */
typedef struct {
    int64_t ticks;
    double slow_share;
    double threshold;
    double lasting;
    double released;
    double bias;
    double tared_after;
    double anchored;
    double edge;
    double firm_edge;
    double half_length;
    double half_width;
    double carries;
    double unlikely;
    double period;
    double tare_time;
    double tare_share;
    double tare_height;
    const double *reading;
    const double *above;
    double *filtered;
    double *tare;
    double *wrench;
    double *slow;
    double *tared;
    int64_t *count;
    int64_t *felt;
    int64_t *firm;
} SoleContact;

int64_t sole_contact_update(const SoleContact *contact, double share, int64_t still);

#endif
