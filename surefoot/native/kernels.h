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

/* A frame fixed to a joint's body: its placement in Pinocchio's data, and where its motion goes. */
typedef struct {
    const double *joint_rotation_columns;
    const double *joint_position;
    const double *joint_velocity;
    const double *joint_acceleration;
    const double *placement_rotation;
    const double *placement_position;
    int64_t supporting;
    const int64_t *columns;
    double *rotation_columns;
    double *position;
    double *jacobian;
    double *velocity;
    double *bias;
} Frame;

/* A sole: its frame, and what `RobotTerms` tells of it. */
typedef struct {
    const Frame *frame;
    double *position;
    double *rotation;
    double *pose;
    double *contact_position;
    double *contact_rotation;
    double *wrench_map;
} Sole;

/* Counterpart of `wbc.model.RobotTerms`, whose names these are. */
typedef struct {
    int64_t nq;
    int64_t nv;
    double model_mass;
    double wrench_unit;
    const double *mass;
    const double *load_force;
    const double *load_moment;
    const double *q;
    const double *v;
    const double *joint_jacobian_columns;
    const double *momentum;
    const double *linear_momentum;
    double *angular_momentum;
    const double *mass_matrix;
    const double *bias;
    const double *com;
    const double *base_rotation_columns;
    const Sole *left;
    const Sole *right;
    const Frame *torso;
    double *com_velocity;
    double *base_angular_velocity;
    double *sole_position;
    double *contact_position;
    double *contact_rotation;
    double *sole_jacobian;
    double *sole_velocity;
    double *sole_bias;
    double *sole_wrench_map;
    const double *torso_jacobian;
    const double *torso_velocity;
    const double *torso_bias;
    double *to_sole;
} Terms;

int64_t terms_update(const Terms *terms);
void terms_place(const Terms *terms);
void terms_unshift(const Terms *terms, int64_t foot);
void terms_shift(const Terms *terms, int64_t foot, double forward, double pitch);

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

/* Where a task writes: its own rows of the stack, scaled, and its target, not scaled. */
typedef struct {
    const Terms *terms;
    const Reference *reference;
    int64_t variables;
    const double *scale;
    double *rows;
    double *target;
} Bench;

/* Counterpart of `wbc.tasks.momentum.CentreOfMass`, its support region and `wbc.balance.com_acceleration`. */
typedef struct {
    const Bench *bench;
    const double *edges;
    const int64_t *edge_count;
    double beyond;
    double dcm;
    double height_stiffness;
    double height_damping;
    double gravity;
} CentreOfMass;

/* Counterpart of `wbc.tasks.momentum.AngularMomentum`. */
typedef struct {
    const Bench *bench;
    double decay;
} AngularMomentum;

/* Counterpart of `wbc.tasks.trunk.Pelvis`; of each hip's roll joint column, sign, lower and upper bound. */
typedef struct {
    const Bench *bench;
    double stiffness;
    double damping;
    int64_t hip_count;
    const double *hips;
    double softened;
} Pelvis;

/* Counterpart of `wbc.tasks.trunk.Torso`. */
typedef struct {
    const Bench *bench;
    double stiffness;
    double damping;
} Torso;

/* Counterpart of `wbc.tasks.swing.SwingFoot`; the columns of the left ankle, then those of the right one. */
typedef struct {
    const Bench *bench;
    double stiffness;
    double damping;
    double toe;
    double side;
    double lifted;
    int64_t ankle_joints;
    const int64_t *ankle_columns;
    const double *ankles;
    const double *lower;
    const double *upper;
    double ahead;
    double yielding;
    double turned_back;
    double resting;
    int64_t *turned;
} SwingFoot;

void task_centre_of_mass(const CentreOfMass *task);
void task_angular_momentum(const AngularMomentum *task);
void task_pelvis(const Pelvis *task);
void task_torso(const Torso *task);
void task_swing_foot(const SwingFoot *task);

/* Counterpart of `wbc.tasks.diagonal.Posture` and `wbc.arm_swing.ArmSwing`; without arms their gain is zero. */
typedef struct {
    const Terms *terms;
    int64_t joints;
    const double *stiffness;
    const double *damping;
    const double *pull;
    double arm_gain;
    int64_t left_arm;
    int64_t right_arm;
    double left_back;
    double right_back;
    double *linear;
} Posture;

/* Counterpart of `wbc.tasks.diagonal.ForceDistribution`. */
typedef struct {
    const Terms *terms;
    const Reference *reference;
    double force;
    double gravity;
    double *linear;
} ForceDistribution;

/* Counterpart of the end of `wbc.tasks.stack.TaskStack.write`: H and g from rows and targets. */
typedef struct {
    int64_t variables;
    int64_t rows_count;
    const double *rows;
    double *target;
    const double *scale;
    const double *unscale;
    const double *diagonal;
    const double *linear;
    double *H;
    double *g;
} Stack;

void cost_posture(const Posture *term);
void cost_force_distribution(const ForceDistribution *term);
void stack_assemble(const Stack *stack);

/* Counterpart of `wbc.dynamics.HardConstraints` and `wbc.limits.AccelerationBounds`. */
typedef struct {
    const Terms *terms;
    const Reference *reference;
    int64_t variables;
    double damping;
    double softening;
    double sinking;
    double levelling;
    int64_t leaning;
    int64_t free_row;
    int64_t ankle_joints;
    const int64_t *ankle_columns;
    const int64_t *tipping_columns;
    double unbounded;
    const double *torque_span;
    double reach_time;
    double position_rate;
    double velocity_rate;
    const double *positions;
    const double *velocities;
    double *rates;
    double *A;
    double *lower;
    double *upper;
} HardRows;

void hard_rows_write(const HardRows *rows, int64_t left, int64_t right, int64_t rolling, double left_cap,
                     double right_cap);

/* Counterpart of `wbc.separation.Separation._gradient`: two points of two bodies, and the direction from a to b. */
typedef struct {
    const Terms *terms;
    const double *direction;
    int64_t first_count;
    const int64_t *first_columns;
    int64_t second_count;
    const int64_t *second_columns;
    const double *points;
    double *gradient;
} Distance;

double distance_rate(const Distance *distance);

/* Counterpart of the distances in `wbc.separation.Separation.write`; `poses` holds addresses, four for each pair. */
typedef struct {
    int64_t count;
    const int64_t *poses;
    const double *centres;
    const double *radii;
    double attention;
    double *places;
    const double *distances;
    int64_t *due;
} Pairs;

int64_t pairs_due(const Pairs *pairs);

/* Kernels without numbers of their own, one after another: addresses of functions and of their structs. */
typedef struct {
    int64_t count;
    const int64_t *functions;
    const int64_t *structs;
} Calls;

void calls_run(const Calls *calls);

/* Counterpart of `wbc.controller.WholeBodyController.build`, but for the rows of pairs that are due. */
typedef struct {
    const Calls *tasks;
    const HardRows *hard;
    const Pairs *pairs;
} QpBuild;

int64_t qp_build(const QpBuild *build, int64_t left, int64_t right, int64_t rolling, double left_cap, double right_cap);

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

/* Counterpart of `wbc.balance.SupportRegion`. */
typedef struct {
    const double *corners;
    const double *positions;
    const double *rotations;
    double *edges;
    int64_t *edge_count;
} Support;

void support_rebuild(const Support *support, int64_t left, int64_t right, int64_t rolling);

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
