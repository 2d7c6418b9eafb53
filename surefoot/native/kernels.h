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

/* Counterpart of `wbc.balance.SupportRegion`. */
typedef struct {
    const double *corners;
    const double *positions;
    const double *rotations;
    double *edges;
    int64_t *edge_count;
} Support;

void support_rebuild(const Support *support, int64_t left, int64_t right, int64_t rolling);

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


#endif
