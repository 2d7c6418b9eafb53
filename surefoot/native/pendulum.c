/* The pendulum over a window of samples; see `planner.model.nominal`. */
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
