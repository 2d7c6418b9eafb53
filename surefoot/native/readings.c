/* What sensors add to the truth; see `sim.readings`. */
#include "algebra.h"
#include "kernels.h"

/* Products in the order of numpy's, so that readings are those of plain Python to the bit where its library fuses. */

/* A x */
static void fused_rotate(const double *A, const double *x, double *out) {
    for (int i = 0; i < 3; i++) out[i] = fused_sum(A[3 * i + 1], x[1], A[3 * i], x[0], A[3 * i + 2], x[2]);
}

/* A' x */
static void fused_rotate_back(const double *A, const double *x, double *out) {
    for (int i = 0; i < 3; i++) out[i] = fused_sum(A[i], x[0], A[3 + i], x[1], A[6 + i], x[2]);
}

static void add_noise(double *values, const Noise *noise, int64_t row) {
    if (noise->silent) return;
    const double *drawn = noise->drawn + row * noise->size;
    for (int64_t i = 0; i < noise->size; i++) values[i] += drawn[i];
}

static void add_drift(double *values, const Drift *drift, int64_t row) {
    if (row >= 0) add_noise(drift->value, drift->steps, row);
    for (int64_t i = 0; i < drift->steps->size; i++) values[i] += drift->value[i];
}

/* Counterpart of `_Encoders.sample`. */
void encoders_sample(const Encoders *encoders) {
    const int64_t row = encoders->drawn->noise, bytes = encoders->joints * sizeof(double);
    double *position = encoders->position;
    for (int64_t i = 0; i < encoders->joints; i++) position[i] = encoders->true_position[i] + encoders->offset[i];
    add_noise(position, encoders->noise, row);
    if (encoders->step > 0.0)
        for (int64_t i = 0; i < encoders->joints; i++)
            position[i] = encoders->step * rint(position[i] / encoders->step);
    memcpy(encoders->torque, encoders->true_torque, bytes);
    add_noise(encoders->torque, encoders->torque_noise, row);
    if (!encoders->say_velocity) return;
    memcpy(encoders->velocity, encoders->true_velocity, bytes);
    add_noise(encoders->velocity, encoders->velocity_noise, row);
}

static void skew(const double *x, double *out) {
    const double K[9] = {0.0, -x[2], x[1], x[2], 0.0, -x[0], -x[1], x[0], 0.0};
    memcpy(out, K, sizeof K);
}

/* Over one body of the chain, as in `ImuChain.__call__`: R, velocity and rate are then those of its axes. */
static void pass_link(const ImuChain *chain, int64_t k, double *R, double *velocity, double *rate) {
    const double *rotation = chain->rotation + 9 * k, *axis = chain->axis + 3 * k, *point = chain->point + 3 * k;
    const double angle = chain->q[7 + chain->joint[k]], speed = chain->v[6 + chain->joint[k]];
    const double sine = sin(angle), rest = 1.0 - cos(angle);
    double turn[9], E[9], lever[9], K[9], at_zero[3], seen[9];
    for (int i = 0; i < 9; i++)
        turn[i] = (i % 4 ? 0.0 : 1.0) + sine * chain->twist[9 * k + i] + rest * chain->square[9 * k + i];
    fused_compose(rotation, turn, E);
    memcpy(lever, chain->lever + 9 * k, sizeof lever);
    if (chain->beside[k]) {
        fused_rotate(rotation, point, at_zero);
        fused_rotate(E, point, seen);
        for (int i = 0; i < 3; i++) at_zero[i] -= seen[i];
        skew(at_zero, K);
        for (int i = 0; i < 9; i++) lever[i] += K[i];
    }
    fused_rotate(lever, rate, seen);
    for (int i = 0; i < 3; i++) seen[i] = velocity[i] - seen[i];
    fused_rotate_back(E, seen, velocity);
    fused_rotate_back(E, rate, seen);
    for (int i = 0; i < 3; i++) rate[i] = seen[i] + axis[i] * speed;
    fused_compose(R, E, seen);
    memcpy(R, seen, sizeof seen);
    if (chain->beside[k]) {
        const double spin[3] = {axis[0] * speed, axis[1] * speed, axis[2] * speed};
        skew(point, K);
        fused_rotate(K, spin, seen);
        for (int i = 0; i < 3; i++) velocity[i] += seen[i];
    }
}

/* Counterpart of `ImuChain.__call__`: rotation, velocity and angular velocity of the IMU. */
static void imu_motion(const ImuChain *chain, double *turned, double *moved, double *rate) {
    const double x = chain->q[3], y = chain->q[4], z = chain->q[5], w = chain->q[6];
    double R[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
        2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
        2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y),
    };
    double velocity[3], seen[3], turning[3];
    memcpy(velocity, chain->v, sizeof velocity);
    memcpy(turning, chain->v + 3, sizeof turning);
    for (int64_t k = 0; k < chain->links; k++) pass_link(chain, k, R, velocity, turning);
    fused_rotate(chain->place, turning, seen);
    for (int i = 0; i < 3; i++) seen[i] = velocity[i] - seen[i];
    fused_rotate(R, seen, moved);
    fused_compose(R, chain->mount, turned);
    fused_rotate_back(chain->mount, turning, rate);
}

/* Counterpart of `turn_between`, over a time. */
static void mean_rate(const Imu *imu, const double *after, double *out) {
    double R[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            R[3 * i + j] = fused_sum(imu->rotation[i], after[j], imu->rotation[3 + i], after[3 + j],
                                   imu->rotation[6 + i], after[6 + j]);
    out[0] = 0.5 * (R[7] - R[5]);
    out[1] = 0.5 * (R[2] - R[6]);
    out[2] = 0.5 * (R[3] - R[1]);
    const double sine = sqrt(fused_sum(out[0], out[0], out[1], out[1], out[2], out[2]));
    if (sine >= imu->small) {
        const double cosine = 0.5 * (R[0] + R[4] + R[8] - 1.0), scale = atan2(sine, cosine) / sine;
        for (int i = 0; i < 3; i++) out[i] *= scale;
    }
    for (int i = 0; i < 3; i++) out[i] /= imu->period;
}

/* Counterpart of `_Imu.sample`. */
void imu_sample(const Imu *imu) {
    const DrawnRows *drawn = imu->drawn;
    double R[9], velocity[3], rate[3], pushed[3], error[3] = {0.0};
    imu_motion(imu->chain, R, velocity, rate);
    if (drawn->drift < 0) {
        memcpy(imu->mean_rate, rate, sizeof rate);
        for (int i = 0; i < 3; i++) pushed[i] = -imu->gravity[i];
        fused_rotate_back(R, pushed, imu->force);
    } else {
        double both[9];
        mean_rate(imu, R, imu->mean_rate);
        for (int i = 0; i < 3; i++)
            pushed[i] = 0.5 * ((velocity[i] - imu->velocity[i]) / imu->period - imu->gravity[i]);
        for (int i = 0; i < 9; i++) both[i] = imu->rotation[i] + R[i];
        fused_rotate_back(both, pushed, imu->force);
    }
    memcpy(imu->rotation, R, sizeof R);
    memcpy(imu->velocity, velocity, sizeof velocity);
    add_drift(error, imu->gyro_bias, drawn->drift);
    add_noise(error, imu->gyro_noise, drawn->noise);
    add_drift(imu->force, imu->force_bias, drawn->drift);
    add_noise(imu->force, imu->force_noise, drawn->noise);
    for (int i = 0; i < 3; i++) {
        imu->rate[i] = clamp(rate[i] + error[i], -imu->most_rate, imu->most_rate);
        imu->mean_rate[i] = clamp(imu->mean_rate[i] + error[i], -imu->most_rate, imu->most_rate);
        imu->force[i] = clamp(imu->force[i], -imu->most_force, imu->most_force);
    }
}

/* Counterpart of `_Feet.sample`. */
void feet_sample(const Feet *feet) {
    memcpy(feet->wrench, feet->true_wrench, 12 * sizeof(double));
    add_drift(feet->wrench, feet->bias, feet->drawn->drift);
    add_noise(feet->wrench, feet->noise, feet->drawn->noise);
}
