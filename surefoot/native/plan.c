/* A plan between its samples (see `planner.plan`), and the whole-body reference of it (`scenarios.run.reference`). */
#include "algebra.h"
#include "kernels.h"

/* Columns of the table: linear functions, polynomials, their rates, their second derivatives; see `_enter`. */
enum { LINEAR = 7, MOTIONS = 9, RATES = LINEAR + MOTIONS, BENDS = RATES + MOTIONS, COLUMNS = BENDS + MOTIONS };
/* Behind them in a point: the pendulum's ZMP, the ZMP, the DCM. */
enum { POINT = COLUMNS + 6 };
/* Where both ends of the interval are in what is given of it: each quantity first at its begin, then at its end. */
enum { COM = 0, VELOCITY = 6, ACCELERATION = 12, LINEARS = 18, JERK = 32 };

/* Coefficients of a quintic between two states; counterpart of `planner.geometry.quintic`. */
static void quintic(const double *start, const double *end, double t, double *coefficients) {
    const double gap = end[0] - start[0] - t * start[1] - 0.5 * t * t * start[2];
    const double speed = t * (end[1] - start[1] - t * start[2]), bend = t * t * (end[2] - start[2]);
    const double t3 = t * t * t;
    coefficients[0] = start[0];
    coefficients[1] = start[1];
    coefficients[2] = 0.5 * start[2];
    coefficients[3] = (10.0 * gap - 4.0 * speed + 0.5 * bend) / t3;
    coefficients[4] = (-15.0 * gap + 7.0 * speed - bend) / (t3 * t);
    coefficients[5] = (6.0 * gap - 3.0 * speed + 0.5 * bend) / (t3 * t * t);
}

/* Fills the table of an interval from what the plan has at both its ends, and the swing's polynomials. */
void plan_interval_enter(const PlanInterval *interval) {
    const double *ends = interval->ends, length = interval->length;
    /* Widths of the linear quantities: ZMP reference, ZMP offset, frequency, stiffness, load. */
    static const int widths[5] = {2, 2, 1, 1, 1};
    double *table = interval->table, height[2][3], coefficients[6];
    memset(table, 0, 6 * COLUMNS * sizeof(double));
    for (int part = 0, column = 0; part < 5; column += widths[part++])
        for (int i = 0; i < widths[part]; i++) {
            const double *from = ends + LINEARS + 2 * column + i;
            table[column + i] = from[0];
            table[COLUMNS + column + i] = (from[widths[part]] - from[0]) / length;
        }
    for (int i = 0; i < 2; i++) {
        table[LINEAR + i] = ends[COM + i];
        table[COLUMNS + LINEAR + i] = ends[VELOCITY + i];
        table[2 * COLUMNS + LINEAR + i] = 0.5 * ends[ACCELERATION + i];
        table[3 * COLUMNS + LINEAR + i] = ends[JERK + i] / 6.0;
        for (int k = 0; k < 3; k++) height[i][k] = ends[6 * k + 3 * i + 2];
    }
    quintic(height[0], height[1], length, coefficients);
    for (int k = 0; k < 6; k++) {
        table[COLUMNS * k + LINEAR + 2] = coefficients[k];
        memcpy(table + COLUMNS * k + LINEAR + 3, interval->swing + 6 * k, 6 * sizeof(double));
    }
    for (int k = 0; k < 5; k++)
        for (int i = 0; i < MOTIONS; i++)
            table[COLUMNS * k + RATES + i] = (k + 1.0) * table[COLUMNS * (k + 1) + LINEAR + i];
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < MOTIONS; i++)
            table[COLUMNS * k + BENDS + i] = (k + 1.0) * table[COLUMNS * (k + 1) + RATES + i];
}

static void evaluate(const double *table, double t, double *point) {
    memcpy(point, table + 5 * COLUMNS, COLUMNS * sizeof(double));
    for (int k = 4; k >= 0; k--)
        for (int i = 0; i < COLUMNS; i++) point[i] = point[i] * t + table[COLUMNS * k + i];
    const double omega = point[4], stiffness = point[5];
    for (int i = 0; i < 2; i++) {
        const double pendulum = point[LINEAR + i] - point[BENDS + i] / stiffness;
        point[COLUMNS + i] = pendulum;
        point[COLUMNS + 2 + i] = pendulum + point[2 + i];
        point[COLUMNS + 4 + i] = point[LINEAR + i] + point[RATES + i] / omega;
    }
}

/* Whether an instant is within the interval that was entered last, with its swing foot landed or not as it was then. */
static int is_within(const PlanInterval *plan, double time) {
    const double place = (time - plan->begin) / plan->length + 1e-6;
    const int64_t i = place < 0.0 ? 0 : place > (double)plan->last ? plan->last : (int64_t)place;
    return i == plan->entered && (time >= plan->touchdown) == plan->landed;
}

/* Time since the begin of the interval. */
static double local(const PlanInterval *plan, double time) {
    const double passed = time - plan->start;
    return passed < 0.0 ? 0.0 : passed > plan->length ? plan->length : passed;
}

/* Two points: at `now`; at `middle`, with positions and velocities of now. Zero where the interval is not theirs. */
int64_t plan_interval_sample(const PlanInterval *interval, double now, double middle) {
    double *point = interval->points;
    if (!is_within(interval, now) || !is_within(interval, middle)) return 0;
    evaluate(interval->table, local(interval, now), point);
    evaluate(interval->table, local(interval, middle), point + POINT);
    memcpy(point + POINT + LINEAR, point + LINEAR, 2 * MOTIONS * sizeof(double));
    return 1;
}

/* Counterpart of `planner.geometry.sole_rates`, of angles yaw, pitch, roll. */
static void sole_rates(const double *angles, const double *rates, const double *bends, double *velocity,
                       double *acceleration) {
    const double turn = rates[0], tilt = rates[1], lean = rates[2];
    const double c = cos(angles[0]), s = sin(angles[0]), cp = cos(angles[1]), sp = sin(angles[1]);
    const double across = bends[1] + lean * turn * cp, along = bends[2] * cp - lean * tilt * sp - tilt * turn;
    velocity[0] = lean * cp * c - tilt * s;
    velocity[1] = lean * cp * s + tilt * c;
    velocity[2] = turn - lean * sp;
    acceleration[0] = along * c - across * s;
    acceleration[1] = along * s + across * c;
    acceleration[2] = bends[0] - bends[2] * sp - lean * tilt * cp;
}

/* Counterpart of `planner.geometry.sole_rotation`. */
static void sole_rotation(const double *angles, double *R) {
    const double cy = cos(angles[0]), cp = cos(angles[1]), cr = cos(angles[2]);
    const double sy = sin(angles[0]), sp = sin(angles[1]), sr = sin(angles[2]);
    const double rows[9] = {
        cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
        -sp,     cp * sr,                cp * cr,
    };
    memcpy(R, rows, sizeof rows);
}

/* Counterpart of `planner.swing.heel_off.FootRoll.evaluate` of a clock that goes as the time does. */
static void roll_evaluate(const PlanReference *plan, double time, double *roll) {
    const double span = plan->roll_end - plan->roll_start, s = (time - plan->roll_start) / span;
    memset(roll, 0, 3 * sizeof(double));
    if (!(s > 0.0 && s < 1.0)) return;
    const double w = s * (1.0 - s), tilt = 1.0 - 2.0 * s;
    roll[0] = plan->roll_angle * (64.0 * pow(w, 3.0));
    roll[1] = plan->roll_angle * (192.0 * pow(w, 2.0) * tilt) / span;
    roll[2] = plan->roll_angle * (384.0 * w * (pow(tilt, 2.0) - w)) / pow(span, 2.0);
}

/* Samples the plan (see `plan_interval_sample`) and fills the reference from the second point; of the foot that swings
 * yaw and normal are its own. Gives the foot that rolls then, -1 for none, -2 where the interval is another. */
int64_t plan_reference_fill(const PlanReference *plan, double now, double middle) {
    if (!plan_interval_sample(plan->interval, now, middle)) return -2;
    const double *point = plan->interval->points + POINT, *swing = point + LINEAR + 3, *rate = point + RATES + 3;
    const double *bend = point + BENDS + 3;
    const int64_t swing_foot = plan->interval->swing_foot;
    int64_t rolling_foot = -1;
    Reference *reference = plan->reference;
    double yaw[2] = {plan->yaw[0], plan->yaw[1]};
    memcpy(reference->com, point + LINEAR, sizeof reference->com);
    memcpy(reference->com_velocity, point + RATES, sizeof reference->com_velocity);
    memcpy(reference->com_acceleration, point + BENDS, sizeof reference->com_acceleration);
    for (int i = 0; i < 2; i++) {
        reference->zmp[i] = point[COLUMNS + i];
        reference->zmp_offset[i] = point[COLUMNS + 2 + i] - point[COLUMNS + i];
    }
    memcpy(reference->swing_position, swing, sizeof reference->swing_position);
    memcpy(reference->swing_velocity, rate, sizeof reference->swing_velocity);
    memcpy(reference->swing_acceleration, bend, sizeof reference->swing_acceleration);
    sole_rates(swing + 3, rate + 3, bend + 3, reference->swing_angular_velocity,
               reference->swing_angular_acceleration);
    sole_rotation(swing + 3, reference->swing_rotation);
    memcpy(reference->ground_normal, plan->normal, sizeof reference->ground_normal);
    if (swing_foot >= 0) {
        yaw[swing_foot] = swing[3];
        memcpy(reference->ground_normal + 3 * swing_foot, plan->landing_normal, 3 * sizeof(double));
    }
    reference->omega = point[4];
    reference->stiffness = point[5];
    reference->heading = 0.5 * (yaw[0] + yaw[1]);
    reference->heading_rate = 0.5 * rate[3];
    reference->load_share[0] = point[6];
    reference->load_share[1] = 1.0 - point[6];
    if (plan->rolling_foot >= 0) {
        roll_evaluate(plan, middle, reference->roll);
        if (plan->roll_start < middle && middle < plan->roll_end) rolling_foot = plan->rolling_foot;
    } else
        memset(reference->roll, 0, sizeof reference->roll);
    reference->swing_foot = (double)swing_foot;
    reference->rolling_foot = (double)rolling_foot;
    reference->catching = (double)plan->catching;
    return rolling_foot;
}

/* Centre and velocity of a sole that is turned about its toe edge by a pitch, which changes at a rate. */
void roll_centre(const RollCentre *roll, double toe, double pitch, double rate) {
    const double sine = sin(pitch), cosine = cos(pitch), none[3] = {0.0};
    const double back[3] = {toe * (1.0 - cosine), 0.0, toe * sine};
    const double rolling[3] = {toe * rate * sine, 0.0, toe * rate * cosine};
    double R[9], away[3], moving[3], spin[3], turn[3], unused[3];
    sole_rotation(roll->level + 3, R);
    sole_rates(roll->level + 3, roll->rates + 3, none, spin, unused);
    rotate(R, back, away);
    rotate(R, rolling, moving);
    cross(spin, away, turn);
    for (int i = 0; i < 3; i++) {
        roll->position[i] = roll->level[i] + away[i];
        roll->velocity[i] = roll->rates[i] + moving[i] + turn[i];
    }
}
