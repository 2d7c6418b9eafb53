/* The QPs of a plan whose footsteps are variables; see `planner.laws.footstep_tvmpc`, whose names these are. */
#include "algebra.h"
#include "kernels.h"

/* Variables after the moves: two footstep shifts, ZMP slack, terminal slack. */
enum { SHIFTS = 2, EXTRA = 4 };

/* Counterpart of `planner.model.dcm.viability_weights`. */
static void viability(const double *stiffness, const double *omega, double sample_time, int64_t count,
                      double *weights) {
    double sum = 0.0, before = 1.0;
    weights[0] = 0.0;
    for (int64_t k = 1; k < count; k++) {
        sum += stiffness[k] / omega[k] + stiffness[k - 1] / omega[k - 1];
        const double decay = exp(-0.5 * sample_time * sum), share = 0.5 * (before - decay);
        weights[k - 1] += share;
        weights[k] = share;
        before = decay;
    }
    weights[count - 1] += before;
}

/* Counterpart of `_linear_errors`: rows of G and right sides without the box, of one axis after the other. */
static void write_errors(const FootstepQps *qps, int64_t samples, double *end_box) {
    const NominalMotion *motion = qps->motion;
    const int64_t n = qps->horizon, m = qps->moves, width = m + EXTRA, rows = 2 * n + 2, block = (n + 1) * m;
    const double t = motion->sample_time, *stiffness = motion->stiffness, *last = qps->response + n * m;
    const double end_share = 1.0 / qps->omega[n], *gain = qps->gain + SHIFTS * n;
    double beside[2][3], *end = qps->G + width * 2 * n;
    for (int axis = 0; axis < 2; axis++) {
        beside[axis][0] = qps->state[3 * axis] - motion->com[axis];
        beside[axis][1] = qps->state[3 * axis + 1] - motion->velocity[axis];
        beside[axis][2] = qps->state[3 * axis + 2] - motion->acceleration[axis];
    }
    for (int64_t k = 1; k <= n; k++) {
        const double *position = qps->response + m * k, *acceleration = position + 2 * block;
        const double softness = 1.0 / stiffness[k], time = t * k;
        double *row = qps->G + width * (k - 1);
        for (int64_t j = 0; j < m; j++) row[j] = position[j] - softness * acceleration[j];
        for (int step = 0; step < SHIFTS; step++) row[m + step] = -qps->gain[SHIFTS * k + step];
        for (int axis = 0; axis < 2; axis++) {
            const double *b = beside[axis];
            qps->h[rows * axis + k - 1] = b[0] + time * b[1] + (0.5 * time * time) * b[2] - softness * b[2];
        }
    }
    viability(stiffness + n, qps->omega + n, t, samples - n, qps->weights);
    for (int64_t j = 0; j < m; j++) end[j] = last[j] + end_share * last[block + j];
    for (int step = 0; step < SHIFTS; step++) {
        double sum = 0.0;
        for (int64_t k = 0; k < samples - n; k++) sum += qps->weights[k] * gain[SHIFTS * k + step];
        end[m + step] = -sum;
    }
    for (int axis = 0; axis < 2; axis++) {
        const double *b = beside[axis], time = t * n, speed = b[1] + time * b[2];
        qps->h[rows * axis + 2 * n] = b[0] + time * b[1] + (0.5 * time * time) * b[2] + end_share * speed;
        end_box[axis] = qps->terminal_margin * qps->half_size[2 * n + axis];
    }
}

/* Counterpart of `_cost`, from the errors that stand in G and h. */
static void write_cost(const FootstepQps *qps) {
    const int64_t n = qps->horizon, m = qps->moves, width = m + EXTRA, rows = 2 * n + 2;
    memset(qps->P, 0, width * width * sizeof(double));
    memset(qps->q, 0, 2 * width * sizeof(double));
    for (int64_t k = 0; k <= n; k++) {
        const int64_t at = k < n ? k : 2 * n;
        const double *row = qps->G + width * at, weight = k < n ? 2.0 : 2.0 * qps->terminal_weight;
        const double x = weight * qps->h[at], y = weight * qps->h[rows + at];
        for (int64_t i = 0; i < m + SHIFTS; i++) {
            const double weighted = weight * row[i];
            for (int64_t j = i; j < m + SHIFTS; j++) qps->P[width * i + j] += weighted * row[j];
            qps->q[i] += x * row[i];
            qps->q[width + i] += y * row[i];
        }
    }
    for (int64_t i = 0; i < m + SHIFTS; i++) {
        for (int64_t j = 0; j < i; j++) qps->P[width * i + j] = qps->P[width * j + i];
        qps->P[width * i + i] += 2.0 * (i < m ? qps->jerk_weight : qps->step_weight);
    }
    qps->P[(width + 1) * (m + 2)] = 2.0 * qps->zmp_slack[0];
    qps->P[(width + 1) * (m + 3)] = 2.0 * qps->terminal_slack[0];
    for (int axis = 0; axis < 2; axis++) {
        qps->q[width * axis + m + 2] = qps->zmp_slack[1];
        qps->q[width * axis + m + 3] = qps->terminal_slack[1];
    }
}

/* Counterpart of `_inequalities`, from the errors that stand in G and h. */
static void write_inequalities(const FootstepQps *qps, const double *end_box) {
    const int64_t n = qps->horizon, m = qps->moves, width = m + EXTRA, rows = 2 * n + 2;
    for (int64_t k = 0; k <= n; k++) {
        const int64_t above = k < n ? k : 2 * n, below = k < n ? n + k : 2 * n + 1;
        double *row = qps->G + width * above, *other = qps->G + width * below;
        row[m + 2] = other[m + 2] = k < n ? -1.0 : 0.0;
        row[m + 3] = other[m + 3] = k < n ? 0.0 : -1.0;
        for (int64_t j = 0; j < m + SHIFTS; j++) other[j] = -row[j];
        for (int axis = 0; axis < 2; axis++) {
            double *h = qps->h + rows * axis;
            const double error = h[above], box = k < n ? qps->half_size[2 * (k + 1) + axis] : end_box[axis];
            h[above] = box - error;
            h[below] = box + error;
        }
    }
}

/* Counterpart of `_bounds` and of `planner.model.dcm.jerk_range`. */
static void write_bounds(const FootstepQps *qps) {
    const int64_t m = qps->moves, width = m + EXTRA;
    for (int axis = 0; axis < 2; axis++) {
        double *lower = qps->lower + width * axis, *upper = qps->upper + width * axis;
        for (int64_t move = 0; move < m; move++) {
            const int64_t end = move + 1 < m ? qps->starts[move + 1] : qps->horizon;
            double least = INFINITY, most = -INFINITY;
            for (int64_t k = qps->starts[move]; k < end; k++) {
                const double jerk = qps->motion->jerk[2 * k + axis];
                least = jerk < least ? jerk : least;
                most = jerk > most ? jerk : most;
            }
            lower[move] = -qps->jerk_limit - least < 0.0 ? -qps->jerk_limit - least : 0.0;
            upper[move] = qps->jerk_limit - most > 0.0 ? qps->jerk_limit - most : 0.0;
        }
        for (int step = 0; step < SHIFTS; step++) {
            lower[m + step] = qps->step_lower[2 * step + axis];
            upper[m + step] = qps->step_upper[2 * step + axis];
        }
        lower[m + 2] = lower[m + 3] = 0.0;
        upper[m + 2] = upper[m + 3] = INFINITY;
    }
}

void footstep_qps_make(const FootstepQps *qps, int64_t samples) {
    double end_box[2];
    nominal_motion_make(qps->motion, samples);
    write_errors(qps, samples, end_box);
    write_cost(qps);
    write_inequalities(qps, end_box);
    write_bounds(qps);
}

/* Returns whether an axis was not solved. */
int64_t footstep_motion_make(const FootstepMotion *motion, int64_t samples) {
    const FootstepQps *qps = motion->qps;
    const BoundedQp *axes[2] = {motion->x, motion->y};
    const int64_t m = qps->moves;
    footstep_qps_make(qps, samples);
    for (int axis = 0; axis < 2; axis++) {
        if (bounded_qp_solve(axes[axis], axis)) return 1;
        const double *z = axes[axis]->x;
        for (int64_t move = 0; move < m; move++) {
            const int64_t end = move + 1 < m ? qps->starts[move + 1] : qps->horizon;
            for (int64_t k = 2 * qps->starts[move] + axis; k < 2 * end; k += 2)
                motion->jerk[k] = z[move] + qps->motion->jerk[k];
        }
        for (int which = 0; which < 2; which++) {
            motion->shifts[2 * which + axis] = z[m + which];
            motion->slack[2 * which + axis] = z[m + SHIFTS + which];
        }
    }
    return 0;
}
