/* The state of the invariant filter from tick to tick; see `wbc.estimation.invariant_filter`. */
#include "algebra.h"
#include "kernels.h"

enum { POSE = 6, BIASES = 21, FIXED = 27 };

/* Counterpart of `InvariantFilter.propagate`. */
void filter_propagate(const Filter *filter, double time) {
    double x[3], half[9], middle[9], specific[3], *v = filter->columns, *p = filter->columns + 3;
    for (int i = 0; i < 3; i++) x[i] = 0.5 * time * (filter->rate[i] - filter->gyro_bias[i]);
    for (int i = 0; i < 3; i++) specific[i] = filter->force[i] - filter->force_bias[i];
    rotation_of(x, half);
    compose(filter->R, half, middle);
    rotate(middle, specific, filter->acceleration);
    filter->acceleration[2] -= filter->gravity;
    for (int i = 0; i < 3; i++) {
        p[i] += time * v[i] + 0.5 * time * time * filter->acceleration[i];
        v[i] += time * filter->acceleration[i];
    }
    compose(middle, half, filter->R);
}

/* Counterpart of `Stand.move`. */
static void move(const Filter *filter, const double *x) {
    double E[9], seen[9];
    rotation_of(x, E);
    compose(E, filter->R, seen);
    memcpy(filter->R, seen, sizeof seen);
    for (int column = 0; column < 4; column++) {
        double *at = filter->columns + 3 * column;
        rotate(E, at, seen);
        for (int i = 0; i < 3; i++) at[i] = seen[i] + x[3 + 3 * column + i];
    }
    for (int k = 0; k < 2; k++) {
        double *Z = filter->Z + 9 * k;
        rotation_of(x + 15 + 3 * k, E);
        compose(E, Z, seen);
        memcpy(Z, seen, sizeof seen);
    }
    for (int i = 0; i < 3; i++) {
        filter->gyro_bias[i] += x[BIASES + i];
        filter->force_bias[i] += x[BIASES + 3 + i];
    }
    for (int64_t i = FIXED; i < filter->size; i++) filter->offsets[i - FIXED] += x[i];
}

/* Counterpart of `InvariantFilter.correct`; returns whether a foot has slipped, of which nothing is taken. */
int64_t filter_correct(const Filter *filter, double gate) {
    const int64_t rows = POSE * filter->feet_count;
    double seen[9], apart[9], *x = filter->moved;
    for (int64_t i = 0; i < filter->feet_count; i++) {
        const int64_t k = filter->feet[i];
        double *found = filter->residual + POSE * i;
        rotate(filter->R, filter->position + 3 * k, found);
        for (int j = 0; j < 3; j++) found[j] += filter->columns[3 + j] - filter->columns[6 + 3 * k + j];
        compose(filter->R, filter->rotation + 9 * k, seen);
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                apart[3 * a + b] = dot(seen + 3 * a, filter->Z + 9 * k + 3 * b, 3);
        rotation_vector(apart, found + 3);
    }
    double likely = 0.0;
    for (int64_t i = 0; i < rows; i++)
        likely += filter->residual[i] * dot(filter->weights + rows * i, filter->residual, rows);
    if (likely > gate) return 1;
    for (int64_t i = 0; i < filter->size; i++) x[i] = dot(filter->gain + rows * i, filter->residual, rows);
    move(filter, x);
    return 0;
}

/* Counterpart of `SensedState._now`; returns whether it is less than what has diverged. */
int64_t sensed_base_now(const SensedBase *sensed, double late) {
    double base[9], half[9], turn[9], mounted[9], seen[3], way[6], *p = sensed->q, *v = sensed->v;
    const int64_t joints = sensed->joints;
    rotation_of(sensed->offsets + sensed->chain_count, turn);
    compose(sensed->mount, turn, mounted);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) base[3 * i + j] = dot(sensed->R + 3 * i, mounted + 3 * j, 3);
    for (int i = 0; i < 3; i++) seen[i] = sensed->rate[i] - sensed->gyro_bias[i];
    rotate(mounted, seen, v + 3);
    rotate_back(base, sensed->columns, v);
    cross(v + 3, sensed->lever, seen);
    for (int i = 0; i < 3; i++) v[i] -= seen[i];
    rotate(base, sensed->lever, seen);
    for (int i = 0; i < 3; i++) p[i] = sensed->columns[3 + i] - seen[i];
    if (late > 0.0) {
        for (int i = 0; i < 6; i++) way[i] = late * (v[i] + 0.5 * sensed->gained[i]);
        for (int i = 0; i < 3; i++) seen[i] = 0.5 * way[3 + i];
        rotation_of(seen, turn);
        compose(base, turn, half);
        rotate(half, way, seen);
        compose(half, turn, base);
        for (int i = 0; i < 3; i++) p[i] += seen[i];
        for (int i = 0; i < 6; i++) v[i] += sensed->gained[i];
    }
    quaternion(base, p + 3);
    memcpy(p + 7, sensed->position, joints * sizeof(double));
    memcpy(v + 6, sensed->velocity, joints * sizeof(double));
    for (int64_t i = 0; i < sensed->chain_count; i++) p[7 + sensed->chain[i]] -= sensed->offsets[i];
    return dot(p, p, 7) < sensed->farthest * sensed->farthest &&
           dot(v, v, 6 + joints) < sensed->fastest * sensed->fastest;
}
