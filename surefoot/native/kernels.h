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

/* Counterpart of `planner.plan.PlanSampler`: a plan, its interval that was entered last, and two points within that. */
typedef struct {
    double begin;
    double length;
    int64_t last;
    double touchdown;
    int64_t entered;
    int64_t landed;
    double start;
    int64_t swing_foot;
    const double *ends;
    const double *swing;
    double *table;
    double *points;
} PlanInterval;

void plan_interval_enter(const PlanInterval *interval);
int64_t plan_interval_sample(const PlanInterval *interval, double now, double middle);

/* Counterpart of `scenarios.run.reference.whole_body_reference`: where the feet stand, one will land and one rolls. */
typedef struct {
    const PlanInterval *interval;
    const double *yaw;
    const double *normal;
    const double *landing_normal;
    int64_t rolling_foot;
    double roll_start;
    double roll_end;
    double roll_angle;
    int64_t catching;
    Reference *reference;
} PlanReference;

int64_t plan_reference_fill(const PlanReference *plan, double now, double middle);

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

/* Counterpart of `planner.swing.heel_off.FootRoll.centre`: pose and rates of a level sole, and its centre rolled. */
typedef struct {
    const double *level;
    const double *rates;
    double *position;
    double *velocity;
} RollCentre;

void roll_centre(const RollCentre *roll, double toe, double pitch, double rate);

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

/* Counterpart of `planner.model.dcm.nominal_motion`; `upper` is scratch. */
typedef struct {
    double sample_time;
    const double *position;
    const double *zmp;
    const double *stiffness;
    double *upper;
    double *com;
    double *velocity;
    double *acceleration;
    double *jerk;
} NominalMotion;

void nominal_motion_make(const NominalMotion *motion, int64_t samples);

/* Counterpart of `planner.model.leg_chain.LegChain`, as `planner.references.leg_offset` fills it. */
typedef struct {
    double hip_half_width;
    double hip_lever[2];
    double trunk[3];
    double ankle[3];
    double foot_centre[3];
    double foot_outward;
    int64_t rolls_first;
    double length[2];
    double ahead[2];
    double outward[2];
    double mass_ahead[2];
    double trunk_mass;
    double foot_mass;
    double at_hip;
    double at_knee;
    double at_ankle;
    double carried;
    double guess;
    double bend;
    double least_reach;
    int64_t corrections;
    int64_t points;
    int64_t pair_count;
    const int64_t *pairs;
    const double *pair_mass;
} LegChain;

/*
 * Counterpart of `planner.references.nominal_feet.nominal_feet` without a swing that is flown.
 *
 * Of each phase from that of the first sample on `phases` has 34 numbers: of the step whose foot stands its number, and 1
 * for a right one; 1 for a single support; how late its swing begins; begin, end and angle of a roll; then of the swing
 * start and end of the glide, apex, touchdown, starts of rise and fall, progress and height at the touchdown, the
 * coefficients of progress, rise and fall, and the height of its target. `steps` has `count` rows, from number `first` on.
 * A foot that lands higher than its swing ends, or lower, by more than `sunk`, is there. Soles and angles have rows of
 * `most` samples.
 */
typedef struct {
    double sample_time;
    double touching;
    double heading_of_frame;
    double sunk;
    int64_t most;
    const int64_t *which;
    const double *elapsed;
    const double *clock;
    const double *phases;
    int64_t first;
    int64_t count;
    const double *steps;
    double *soles;
    double *heading;
    double *pitch;
} NominalFeet;

void nominal_feet_make(const NominalFeet *feet, int64_t samples);

/*
 * Counterpart of `planner.references.leg_offset.LegOffset.made` with feet that are there.
 *
 * Feet have rows of `most` + 1 samples, heights of `most`. In `scratch`, `points` and `bends` a row takes `stride`,
 * which is 8 more than that; they have 23 rows, and 3 for each point.
 */
typedef struct {
    const LegChain *chain;
    const NominalMotion *motion;
    int64_t most;
    int64_t stride;
    double toe;
    double gravity;
    const double *point;
    const double *stiffness;
    const double *height;
    const double *soles;
    const double *heading;
    const double *pitch;
    double *zmp;
    double *com;
    double *scratch;
    double *points;
    double *bends;
    double *offset;
} LegOffset;

void leg_offset_make(const LegOffset *legs, int64_t samples, int64_t passes);

/* Counterpart of `planner.steps.phases.PhaseTable` and of a `planner.references.zmp_reference.Support`. */
typedef struct {
    int64_t phases;
    const double *start;
    const double *length;
    const double *rest;
    const int64_t *kind;
    const int64_t *support;
    const int64_t *contacts;
    int64_t first;
    int64_t points;
    const double *values;
    const double *steps;
    const double *heights;
    const double *on_left;
} Sight;

/* Counterpart of `planner.references.zmp_reference.hulls_of` two soles: eight outer corners of both, eight inner ones. */
typedef struct {
    double flat;
    double rounding;
    const double *corners;
    double *hulls;
    int64_t *counts;
} SoleHulls;

void sole_hulls_find(const SoleHulls *soles);

/* Counterpart of `planner.references.zmp_reference.support_table`, of the steps of a schedule. */
typedef struct {
    int64_t points;
    int64_t stance;
    int64_t stay;
    const double *free;
    const double *positions;
    const double *yaws;
    const int64_t *supports;
    const double *half_size;
    double *values;
    double *steps;
} SupportTable;

void support_table_fill(const SupportTable *table);

/* Counterpart of `planner.references.window.ReferencePreview`: one sample before a window, those of it, one after. */
typedef struct {
    const Sight *sight;
    int64_t samples;
    int64_t counted;
    double sample_time;
    double gravity;
    double standing;
    const double *apexes;
    int64_t early;
    const double *early_shares;
    double least_pressing;
    double least_height;
    double softening;
    int64_t looked_at;
    const double *course;
    int64_t *which;
    int64_t *kind;
    int64_t *index;
    int64_t *contacts;
    double *clock;
    double *rate;
    double *bend;
    double *elapsed;
    double *length;
    double *fraction;
    double *fraction_rate;
    double *point;
    double *gain;
    double *half_size;
    double *ground;
    double *load_left;
    double *height;
    double *stiffness;
    double *softened;
    double *omega;
} Preview;

void preview_look(const Preview *preview, int64_t steady, double now, int64_t lifts);
void preview_weigh(const Preview *preview);
int64_t preview_transition(const Preview *preview, int64_t soonest, double bound, double z, double speed, double bend);

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

/*
 * Counterpart of `planner.laws.footstep_tvmpc.FootstepTvmpc.build` without a limit on the jerk's rate.
 *
 * `motion` has the ZMP of the reference, the stiffness and the place now. Responses to the moves are those of
 * `planner.model.jerk.Prediction`; `weights` is scratch of the length of the preview.
 */
typedef struct {
    const NominalMotion *motion;
    int64_t horizon;
    int64_t moves;
    const int64_t *starts;
    const double *response;
    double jerk_limit;
    double jerk_weight;
    double step_weight;
    double terminal_weight;
    double terminal_margin;
    double zmp_slack[2];
    double terminal_slack[2];
    const double *state;
    const double *omega;
    const double *gain;
    const double *half_size;
    const double *step_lower;
    const double *step_upper;
    double *weights;
    double *P;
    double *q;
    double *G;
    double *h;
    double *lower;
    double *upper;
} FootstepQps;

void footstep_qps_make(const FootstepQps *qps, int64_t samples);

/* Counterpart of `planner.laws.footstep_tvmpc.FootstepTvmpc.plan`: QPs of both axes, which share what of them depends on
 * P and G alone, and what their solutions mean. */
typedef struct {
    const FootstepQps *qps;
    const BoundedQp *x;
    const BoundedQp *y;
    double *jerk;
    double *shifts;
    double *slack;
} FootstepMotion;

int64_t footstep_motion_make(const FootstepMotion *motion, int64_t samples);

/* Counterpart of `planner.model.jerk.WorldMotion`, whose names these are, over `samples` and the one now. */
typedef struct {
    double sample_time;
    int64_t samples;
    double *state;
    const double *jerk;
    const double *stiffness;
    const double *height;
    const double *offset;
    const double *point;
    const double *gain;
    const double *shifts;
    const double *rotation;
    const double *origin;
    double *com;
    double *world_jerk;
    double *zmp;
    double *world_offset;
    double *reference;
} MotionInWorld;

void motion_in_world(const MotionInWorld *motion);
void state_in_frame(const MotionInWorld *motion, double x, double y, double v_x, double v_y, double a_x, double a_y);

/* Counterpart of a `planner.references.window.Window`, as far as recovery looks at it. */
typedef struct {
    int64_t count;
    double sample_time;
    const double *stiffness;
    const double *omega;
    const double *point;
    const double *gain;
    const double *half_size;
    double *decay;
    double *nominal;
} Outlook;

void outlook_decay(const Outlook *ahead);
void outlook_nominal(const Outlook *ahead, int64_t fresh);
double outlook_margin(const Outlook *ahead, double x, double y, double foot_margin, int64_t fresh);

/* Counterpart of `planner.swing.leg_reach.LegReach`; its unit ways are rows of values at so many shares of a swing. */
typedef struct {
    double radius;
    double stride;
    double hip_width;
    int64_t crosses;
    double across;
    const double *acceleration;
    double touchdown_lead;
    double sample_time;
    int64_t shares;
    const double *at_rest;
    const double *moving;
    const double *around;
    const double *dearer;
} Legs;

/* Counterpart of `planner.recovery.step_adjustment.StepProblem`, with the state that is to be captured, and what of the
 * legs depends on the step's turn. */
typedef struct {
    double com[2];
    double dcm[2];
    double omega;
    double swing[4];
    double double_left;
    double single_left;
    double cycle;
    double shortest;
    double crosses;
    double last;
    double adapted;
    double nominal[2];
    double side;
    double face[4];
    double near;
    double clear;
} Landing;

/* Counterpart of `planner.recovery.capture_margin.CaptureMargin`; of the four edges see there. */
typedef struct {
    const Legs *legs;
    const Landing *step;
    double cycle;
    int64_t timing;
    const double *half;
    const double *apart;
    const double *middle;
    int64_t time_count;
    const double *times;
    double least_double;
    double least_single;
    double longer;
    double *captured;
    double *margins;
} Capture;

void capture_margins(const Capture *capture, int64_t steps, int64_t fixed);

/* Counterpart of `planner.recovery.step_adjustment.StepAdjustment`; its result are time, box, and whether there is
 * more to catch. */
typedef struct {
    const Legs *legs;
    const Landing *step;
    const Outlook *ahead;
    int64_t timing;
    const double *authority;
    int64_t change_count;
    const double *changes;
    double longest_cut;
    double *times;
    double shift_weight;
    double second_weight;
    double time_weight;
    double stretch_weight;
    double swing_weight;
    double cross_factor;
    double least_saving;
    double cop_share;
    double landing_share;
    double landing_spare;
    double tolerance;
    double unheld_share;
    double stand_share;
    double least_double;
    double least_single;
    double *result;
} Adjustment;

int64_t adjustment_solve(const Adjustment *program, double unsure);

/* Counterpart of `wbc.estimation.invariant_filter.InvariantFilter` between two gains: state, readings, gain. */
typedef struct {
    int64_t size;
    int64_t feet_count;
    const int64_t *feet;
    double gravity;
    double *R;
    double *columns;
    double *Z;
    double *gyro_bias;
    double *force_bias;
    double *offsets;
    const double *rate;
    const double *force;
    double *acceleration;
    const double *position;
    const double *rotation;
    const double *gain;
    const double *weights;
    double *residual;
    double *moved;
} Filter;

void filter_propagate(const Filter *filter, double time);
int64_t filter_correct(const Filter *filter, double gate);

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

/*
 * Counterpart of `InvariantFilter` at a new gain: P, noise by names of `wbc.estimation.parameters`, shares of the weight
 * on the soles, their ways on springs, which stand, their Jacobians, and memory for what lies between.
 */
typedef struct {
    const Filter *filter;
    double gyro_density;
    double speed_density;
    double gyro_walk;
    double force_walk;
    double creep;
    double sinking;
    double rocking;
    double light;
    double leaning;
    double unsure;
    double kinematics;
    double turning;
    double encoder;
    int64_t on_springs;
    const double *loads;
    const double *sprung;
    const int64_t *standing;
    const double *jacobian;
    double *P;
    double *gain;
    double *weights;
    double *turned;
    double *PH;
    double *HP;
} Covariance;

void covariance_spread(const Covariance *covariance, double time);
int64_t covariance_weigh(const Covariance *covariance, double ticks);

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

/*
 * Counterpart of `wbc.estimation.estimator.SensedState._now`, and of `SensedBody.base` of an IMU that no joint moves.
 *
 * The arrays of the filter's state, mount and lever of the IMU in the base, its angular velocity with its bias, what
 * the base was planned to gain since, angles and velocities of the joints by their encoders, what has diverged, and
 * where configuration and velocity of the robot go.
 */
typedef struct {
    int64_t joints;
    int64_t chain_count;
    const int64_t *chain;
    double farthest;
    double fastest;
    const double *R;
    const double *columns;
    const double *gyro_bias;
    const double *offsets;
    const double *mount;
    const double *lever;
    const double *rate;
    const double *gained;
    const double *position;
    const double *velocity;
    double *q;
    double *v;
} SensedBase;

int64_t sensed_base_now(const SensedBase *sensed, double late);

#endif
