/* What is done around MuJoCo's steps, and sensors out of its state; see `sim.world` and `sim.sensors`. */
#include "algebra.h"
#include "kernels.h"

static double squares(const double *values, int64_t count) {
    double sum = 0.0;
    for (int64_t i = 0; i < count; i++) sum += values[i] * values[i];
    return sum;
}

int64_t world_begun(const WorldStep *world) {
    if (!(squares(world->torque, world->nu) < INFINITY)) return 0;
    memcpy(world->last_qpos, world->qpos, world->nq * sizeof(double));
    memcpy(world->last_qvel, world->qvel, world->nv * sizeof(double));
    for (int i = 0; i < 3; i++) world->pushed[i] = 0.0;
    return 1;
}

int64_t world_sound(const WorldStep *world, double most) { return squares(world->qacc, world->nv) < most * most; }

/* Counterpart of `_at_sole`: a spatial force about the CoM (torque first) as a wrench at the sole, in its axes. */
static void at_sole(const double *external, const double *com, const double *position, const double *rotation,
                    double *wrench) {
    double lever[3], turn[3];
    for (int i = 0; i < 3; i++) lever[i] = com[i] - position[i];
    cross(lever, external + 3, turn);
    for (int i = 0; i < 3; i++) turn[i] += external[i];
    rotate_back(rotation, external + 3, wrench);
    rotate_back(rotation, turn, wrench + 3);
}

void sensors_read(const Sensors *sensors, int64_t is_pushed) {
    const double *left = is_pushed ? sensors->left_contact : sensors->left_external;
    const double *right = is_pushed ? sensors->right_contact : sensors->right_external;
    const double w = sensors->qpos[3], x = sensors->qpos[4], y = sensors->qpos[5], z = sensors->qpos[6];
    const double base[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
        2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y),
    };
    double specific[3];
    memcpy(sensors->q, sensors->qpos, sensors->nq * sizeof(double));
    sensors->q[3] = x;
    sensors->q[4] = y;
    sensors->q[5] = z;
    sensors->q[6] = w;
    memcpy(sensors->v, sensors->qvel, sensors->nv * sizeof(double));
    rotate_back(base, sensors->qvel, sensors->v);
    memcpy(sensors->torque, sensors->joint_force, (sensors->nv - 6) * sizeof(double));
    for (int i = 0; i < 3; i++) specific[i] = sensors->base_acceleration[i] - sensors->gravity[i];
    rotate_back(sensors->base_rotation, specific, sensors->accelerometer);
    at_sole(left, sensors->com, sensors->left_position, sensors->left_rotation, sensors->wrench);
    at_sole(right, sensors->com, sensors->right_position, sensors->right_rotation, sensors->wrench + 6);
    memcpy(sensors->pushed, sensors->push, 3 * sizeof(double));
}
