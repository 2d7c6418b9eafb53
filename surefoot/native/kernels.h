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


#endif
