/* What makes a state of readings beside the filter, in `wbc.estimation`: joints, gyroscope, contacts, kinematics. */
#include "algebra.h"
#include "kernels.h"

enum { VELOCITY = 3, POSITION = 6, POSE = 6, FIXED = 27, AXES = 3 };
enum { TICK, AT, TOLD };

static double square(double x) { return x * x; }

/* Counterpart of `JointObserver._go_on`, from a tick on. */
static void go_on(const JointObserver *observer, int64_t at, double *position, double *velocity) {
    const int64_t back = observer->clock[TICK] - at, told = observer->clock[TOLD];
    const double T = observer->period;
    const int known = back <= told && back <= observer->kept;
    const double *u = observer->told + (known ? (told - back) % observer->kept : 0) * observer->joints;
    for (int64_t i = 0; i < observer->joints; i++) {
        const double gained = known ? u[i] : 0.0;
        position[i] = position[i] + T * velocity[i] + 0.5 * T * T * gained;
        velocity[i] = velocity[i] + T * gained;
    }
}

/* Counterpart of `JointObserver.update`. */
void joint_observer_update(const JointObserver *observer, int64_t late, int64_t fresh, int64_t says_velocity) {
    const int64_t n = observer->joints, first = observer->clock[TICK] < 0, tick = ++observer->clock[TICK];
    double *position = observer->position, *velocity = observer->velocity;
    const size_t size = n * sizeof(double);
    if (first || says_velocity) {
        memcpy(position, observer->reading, size);
        if (says_velocity) memcpy(velocity, observer->speed, size);
        observer->clock[AT] = tick - late;
    } else {
        const int newer = fresh && tick - late > observer->clock[AT];
        for (; observer->clock[AT] < tick - late; observer->clock[AT]++)
            go_on(observer, observer->clock[AT], position, velocity);
        for (int64_t i = 0; newer && i < n; i++) {
            const double miss = observer->reading[i] - position[i];
            position[i] += observer->moved * miss;
            velocity[i] += observer->sped * miss;
        }
    }
    memcpy(observer->now_position, position, size);
    memcpy(observer->now_velocity, velocity, size);
    for (int64_t at = observer->clock[AT]; at < tick; at++)
        go_on(observer, at, observer->now_position, observer->now_velocity);
}

/* Counterpart of `RateFilter.update`. */
void rate_filter_update(const RateFilter *filter, int64_t ticks, int64_t is_planned) {
    for (int i = 0; i < 3; i++) {
        if (!is_planned || filter->noise == 0.0) {
            filter->rate[i] = filter->seen[i];
            filter->variance[i] = filter->noise;
            continue;
        }
        const double expected = filter->rate[i] + filter->gained[i];
        const double innovation = filter->seen[i] - expected, far = square(innovation);
        double variance = filter->variance[i] + ticks * filter->more;
        if (far > filter->impact * (variance + filter->noise)) variance = far - filter->noise;
        const double gain = variance / (variance + filter->noise);
        filter->rate[i] = expected + gain * innovation;
        filter->variance[i] = gain * filter->noise;
    }
}

/* Counterpart of `SoleContact._feel`. */
static void feel(const SoleContact *contact, int k, double force) {
    const double more = contact->tared[k] < contact->tared_after ? 2.0 * contact->bias : 0.0;
    int64_t *felt = contact->felt + k, *count = contact->count + k, touches;
    if (*felt)
        touches = force > contact->released * (contact->threshold + more);
    else
        touches = force > contact->threshold + more || contact->slow[k] > contact->lasting + more;
    *count = touches != *felt ? *count + 1 : 0;
    if (*count >= contact->ticks) {
        *felt = touches;
        *count = 0;
    }
}

/* Counterpart of `SoleContact._tare_foot`. */
static void tare(const SoleContact *contact, int k, const double *force) {
    double *wrench = contact->wrench + POSE * k;
    if (!(contact->above[k] > contact->tare_height) || contact->felt[k]) return;
    if (!(force[1 - k] > contact->carries) || contact->bias == 0.0) return;
    const double left = contact->unlikely * contact->bias * exp(-contact->tared[k] / contact->tare_time);
    if (!(sqrt(dot(wrench, wrench, 3)) < contact->threshold + left)) return;
    contact->tared[k] += contact->period;
    for (int i = 0; i < POSE; i++) contact->tare[POSE * k + i] += contact->tare_share * wrench[i];
}

/* Counterpart of `SoleContact._flat`. */
static int flat(const SoleContact *contact, int k, const double *force) {
    const double *wrench = contact->wrench + POSE * k, load = force[k];
    const int firm = contact->firm[k] != 0;
    if (force[1 - k] < contact->threshold) return 1;
    if (!(load > contact->anchored * (firm ? 0.5 : 1.0))) return 0;
    const double reach = firm ? contact->firm_edge : contact->edge;
    return fabs(wrench[4]) < reach * contact->half_length * load && fabs(wrench[3]) < reach * contact->half_width * load;
}

/* Counterpart of `SoleContact.update`: takes a share of the reading; feet in bits: still, and returned felt and firm. */
int64_t sole_contact_update(const SoleContact *contact, double share, int64_t still) {
    double force[2];
    for (int i = 0; i < 2 * POSE; i++) {
        if (share > 0.0) contact->filtered[i] += share * (contact->reading[i] - contact->filtered[i]);
        contact->wrench[i] = contact->filtered[i] - contact->tare[i];
    }
    for (int k = 0; k < 2; k++) {
        force[k] = contact->wrench[POSE * k + 2];
        contact->slow[k] += contact->slow_share * (force[k] - contact->slow[k]);
    }
    for (int k = 0; k < 2; k++) {
        feel(contact, k, force[k]);
        tare(contact, k, force);
    }
    int64_t *felt = contact->felt, *firm = contact->firm;
    const int carrying = force[1] > force[0];
    if (!felt[0] && !felt[1] && force[carrying] > contact->threshold) felt[carrying] = 1;
    for (int k = 0; k < 2; k++) firm[k] = felt[k] && flat(contact, k, force) && (still >> k & 1);
    if (!firm[0] && !firm[1]) firm[carrying] = felt[carrying];
    return felt[0] | felt[1] << 1 | firm[0] << 2 | firm[1] << 3;
}

/* Counterpart of `SensedBody.update`, after Pinocchio has placed the joints. */
void sensed_body_update(const SensedBody *body) {
    double joint[9], apart[3], sole[9], at[3], turn[9], mounted[9];
    transpose(body->imu_joint_rotation_columns, joint);
    rotation_of(body->mounting, turn);
    compose(body->mount_rotation, turn, mounted);
    compose(joint, mounted, body->imu_rotation);
    rotate(joint, body->mount_position, body->imu_position);
    for (int i = 0; i < 3; i++) body->imu_position[i] += body->imu_joint_position[i];
    for (int k = 0; k < 2; k++) {
        const SensedSole *foot = k ? body->right : body->left;
        transpose(foot->joint_rotation_columns, joint);
        compose(joint, foot->placement_rotation, sole);
        rotate(joint, foot->placement_position, at);
        for (int i = 0; i < 3; i++) apart[i] = at[i] + foot->joint_position[i] - body->imu_position[i];
        rotate_back(body->imu_rotation, apart, body->position + 3 * k);
        compose_back(body->imu_rotation, sole, body->rotation + 9 * k);
    }
}

/* A sole's centre in the base, shape (3,). */
static void sensed_point(const SensedBody *body, int64_t k, double *at) {
    rotate(body->imu_rotation, body->position + 3 * k, at);
    for (int i = 0; i < 3; i++) at[i] += body->imu_position[i];
}

/* How a joint moves a point of the base's frame that is fixed to what it carries, shape (3,). */
static void sensed_motion(const SensedBody *body, int64_t joint, const double *at, double *moved) {
    const double *column = body->joint_jacobian_columns + POSE * (POSE + joint);
    cross(column + 3, at, moved);
    for (int i = 0; i < 3; i++) moved[i] += column[i];
}

/* Counterpart of `SensedBody.offset_jacobians`, after Pinocchio has computed the joints' Jacobian. */
void sensed_body_jacobians(const SensedBody *body) {
    const int64_t m = body->chain_count, columns = m + AXES;
    for (int k = 0; k < 2; k++) {
        double at[3], seen[POSE], moved[3];
        const double *y = body->position + 3 * k;
        sensed_point(body, k, at);
        for (int64_t c = 0; c < m; c++) {
            const int64_t j = body->chain[c];
            const double carries = body->supporting[body->joints * k + j] - body->supporting[2 * body->joints + j];
            sensed_motion(body, j, at, moved);
            rotate_back(body->imu_rotation, moved, seen);
            rotate_back(body->imu_rotation, body->joint_jacobian_columns + POSE * (POSE + j) + 3, seen + 3);
            for (int i = 0; i < POSE; i++) body->jacobian[columns * (POSE * k + i) + c] = carries * seen[i];
        }
        const double turned[POSE * AXES] = {0.0, y[2], -y[1], -y[2], 0.0, y[0], y[1], -y[0], 0.0,
                                            1.0, 0.0,  0.0,   0.0,   1.0, 0.0,  0.0,  0.0,   1.0};
        for (int i = 0; i < POSE; i++)
            memcpy(body->jacobian + columns * (POSE * k + i) + m, turned + AXES * i, AXES * sizeof(double));
    }
}

/*
 * Counterpart of `Doubt.deviation` but for what follows of the load: variances of the CoM over the stance foot, of its
 * velocity, of the soles' heights, and of one over the other.
 */
void doubt_tell(const Doubt *doubt, int64_t stance, double gyro) {
    const SensedBody *body = doubt->body;
    const Filter *filter = doubt->covariance->filter;
    const int64_t n = filter->size, m = n - FIXED, mount = n - AXES, joints = body->joints;
    const double *R = filter->R, *P = doubt->covariance->P, *C = body->com_jacobian_columns + 3 * POSE;
    double *rows = doubt->rows, *lever = doubt->lever, to_world[9], at[3], apart[3], arm[3], reach[3];
    memset(rows, 0, 8 * n * sizeof(double));
    for (int i = 0; i < 3; i++) /* R times the transpose of the IMU's orientation in the base */
        for (int j = 0; j < 3; j++) to_world[3 * i + j] = dot(R + 3 * i, body->imu_rotation + 3 * j, 3);
    sensed_point(body, stance, at);
    for (int i = 0; i < 3; i++) apart[i] = body->com[i] - at[i];
    rotate_back(body->imu_rotation, apart, lever);
    double com[3] = {0.0}, speed[3] = {0.0};
    int64_t in_chain = 0;
    for (int64_t j = 0; j < joints; j++) {
        double own[3], sole[3], by[3], moving[3];
        sensed_motion(body, j, at, sole);
        for (int i = 0; i < 3; i++) own[i] = C[3 * j + i] - body->supporting[joints * stance + j] * sole[i];
        rotate(to_world, own, by);
        rotate(to_world, C + 3 * j, moving);
        for (int i = 0; i < 3; i++) speed[i] += square(moving[i]);
        if (in_chain < body->chain_count && body->chain[in_chain] == j) {
            for (int i = 0; i < 3; i++) rows[n * i + FIXED + in_chain] = -by[i];
            in_chain++;
        } else {
            for (int i = 0; i < 3; i++) com[i] += square(by[i]);
        }
    }
    for (int i = 0; i < 3; i++) { /* R times the skew matrix of the lever */
        double *row = rows + n * i + mount;
        cross(R + 3 * i, lever, row);
    }
    rotate(R, lever, arm);
    rows[1] = arm[2], rows[2] = -arm[1];
    rows[n] = -arm[2], rows[n + 2] = arm[0];
    rows[2 * n] = arm[1], rows[2 * n + 1] = -arm[0];
    for (int64_t k = 0; k < 2; k++) {
        double *row = rows + n * (3 + k);
        const double *J = body->jacobian + POSE * m * k;
        rotate(R, body->position + 3 * k, reach);
        for (int i = 0; i < 3; i++) reach[i] += filter->columns[3 + i];
        row[0] = reach[1], row[1] = -reach[0];
        row[POSITION + 2] = 1.0;
        for (int64_t j = 0; j < m; j++) row[FIXED + j] = -(R[6] * J[j] + R[7] * J[m + j] + R[8] * J[2 * m + j]);
    }
    for (int64_t i = 0; i < n; i++) rows[5 * n + i] = rows[3 * n + i] - rows[4 * n + i];
    for (int i = 0; i < 2; i++) {
        double *row = rows + n * (6 + i);
        row[i] = 1.0;
        for (int j = 0; j < AXES; j++) row[mount + j] = -R[3 * i + j];
    }
    for (int a = 0; a < 8; a++) {
        double sum = 0.0;
        for (int64_t i = 0; i < n; i++)
            if (rows[n * a + i] != 0.0) sum += rows[n * a + i] * dot(P + n * i, rows + n * a, n);
        doubt->variance[a] = sum > 0.0 ? sum : 0.0;
    }
    rotate(R, body->position + 3 * stance, reach);
    for (int i = 0; i < 3; i++) reach[i] += arm[i];
    const double far = dot(reach, reach, 3);
    for (int i = 0; i < 3; i++) {
        doubt->variance[i] += com[i] * square(doubt->encoder_offset);
        doubt->variance[8 + i] = P[(n + 1) * (VELOCITY + i)] + speed[i] * square(doubt->rate_noise) +
                                 (far - square(reach[i])) * square(gyro);
    }
}
