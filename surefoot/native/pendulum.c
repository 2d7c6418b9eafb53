/* The pendulum over a window of samples; see `planner.model.dcm` and `planner.model.jerk`. */
#include "algebra.h"
#include "kernels.h"

/* Elimination without pivots: the diagonal is the largest of each row. */
void nominal_motion_make(const NominalMotion *motion, int64_t samples) {
    const double t = motion->sample_time, *zmp = motion->zmp, *stiffness = motion->stiffness;
    const double share = t * t / 6.0;
    const int64_t last = samples - 1;
    double *com = motion->com, *velocity = motion->velocity, *acceleration = motion->acceleration;
    double *upper = motion->upper;

    upper[0] = 0.0;
    for (int axis = 0; axis < 2; axis++) {
        com[axis] = motion->position[axis];
        com[2 * last + axis] = zmp[2 * last + axis];
    }
    for (int64_t k = 1; k < last; k++) {
        const double before = share * stiffness[k - 1], here = share * stiffness[k], after = share * stiffness[k + 1];
        const double lower = 1.0 - before, pivot = 1.0 / (-2.0 - 4.0 * here - lower * upper[k - 1]);
        upper[k] = (1.0 - after) * pivot;
        for (int64_t i = 2 * k; i < 2 * k + 2; i++) {
            const double right = -after * zmp[i + 2] - 4.0 * here * zmp[i] - before * zmp[i - 2];
            com[i] = (right - lower * com[i - 2]) * pivot;
        }
    }
    for (int64_t k = last - 1; k > 0; k--)
        for (int64_t i = 2 * k; i < 2 * k + 2; i++) com[i] -= upper[k] * com[i + 2];

    for (int64_t i = 0; i < 2 * samples; i++) acceleration[i] = stiffness[i / 2] * (com[i] - zmp[i]);
    for (int64_t i = 0; i < 2 * last; i++) {
        velocity[i] = (com[i + 2] - com[i]) / t - t / 6.0 * (2.0 * acceleration[i] + acceleration[i + 2]);
        motion->jerk[i] = (acceleration[i + 2] - acceleration[i]) / t;
    }
    for (int64_t i = 2 * last; i < 2 * samples; i++)
        velocity[i] = velocity[i - 2] + 0.5 * t * (acceleration[i - 2] + acceleration[i]);
}

static void turned(const double *rotation, double x, double y, double *out) {
    out[0] = rotation[0] * x + rotation[1] * y;
    out[1] = rotation[2] * x + rotation[3] * y;
}

void motion_in_world(const MotionInWorld *motion) {
    const double t = motion->sample_time, *shifts = motion->shifts, *R = motion->rotation, *origin = motion->origin;
    const int64_t last = motion->samples, count = last + 1;
    double state[2][3];
    memcpy(state, motion->state, sizeof state);
    for (int64_t k = 0; k <= last; k++) {
        const double *offset = motion->offset + 2 * k, *gain = motion->gain + 2 * k;
        const double softness = 1.0 / motion->stiffness[k];
        double zmp[2], reference[2];
        for (int axis = 0; axis < 2; axis++) {
            const double *s = state[axis];
            zmp[axis] = s[0] - softness * s[2] + offset[axis];
            reference[axis] = motion->point[2 * k + axis] + gain[0] * shifts[axis] + gain[1] * shifts[2 + axis];
        }
        turned(R, zmp[0], zmp[1], motion->zmp + 2 * k);
        turned(R, reference[0], reference[1], motion->reference + 2 * k);
        turned(R, offset[0], offset[1], motion->world_offset + 2 * k);
        for (int order = 0; order < 3; order++) {
            double *com = motion->com + 3 * (count * order + k);
            turned(R, state[0][order], state[1][order], com);
            com[2] = motion->height[count * order + k];
        }
        for (int axis = 0; axis < 2; axis++) {
            motion->zmp[2 * k + axis] += origin[axis];
            motion->reference[2 * k + axis] += origin[axis];
            motion->com[3 * k + axis] += origin[axis];
        }
        if (k == last) break;
        turned(R, motion->jerk[2 * k], motion->jerk[2 * k + 1], motion->world_jerk + 2 * k);
        for (int axis = 0; axis < 2; axis++) {
            double *s = state[axis];
            const double u = motion->jerk[2 * k + axis];
            s[0] += t * (s[1] + t * (0.5 * s[2] + t * u / 6.0));
            s[1] += t * (s[2] + 0.5 * t * u);
            s[2] += t * u;
        }
    }
}

/* Counterpart of `planner.model.jerk.WorldMotion.local`; each sum is rounded once, as that of the library which numpy asks. */
void state_in_frame(const MotionInWorld *motion, double x, double y, double v_x, double v_y, double a_x, double a_y) {
    const double *R = motion->rotation, *origin = motion->origin;
    const double values[3][2] = {{x - origin[0], y - origin[1]}, {v_x, v_y}, {a_x, a_y}};
    for (int axis = 0; axis < 2; axis++)
        for (int order = 0; order < 3; order++)
            motion->state[3 * axis + order] = fma(values[order][1], R[2 + axis], values[order][0] * R[axis]);
}
