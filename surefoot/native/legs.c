/* What legs with mass add to the ZMP; see `planner.model.leg_chain` and `planner.references.leg_offset`. */
#include "algebra.h"
#include "kernels.h"

/* Samples that are worked on together: loops of so many rounds become vector instructions. */
enum { LANES = 8 };

/* Order of the points of a body: these of the left leg, each followed by the right leg's. */
enum { HIP = 0, KNEE = 2, ANKLE = 4, FOOT = 6, TRUNK = 8, BESIDE_THIGH = 9, BESIDE_SHANK = 11 };

/* Rows of scratch: forward of left leg, right leg and trunk, what is added to soles for ankles, to these for feet. */
enum { FORWARD = 0, TO_ANKLE = 6, TO_FOOT = 12, RATE = 18, TURN = 20, SPARE = 22 };

typedef struct {
    double x[LANES], y[LANES], z[LANES];
} Vectors;

static double polynomial(const double *c, double t) {
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

void nominal_feet_make(const NominalFeet *feet, int64_t samples) {
    for (int64_t k = 0; k < samples; k++) {
        const double *phase = feet->phases + 34 * (feet->which[k] - feet->which[0]), *swing = phase + 7;
        const int64_t row = (int64_t)phase[0] - feet->first, last = feet->count - 1;
        const double *before = feet->steps + 4 * (row ? row - 1 : last), *stance = feet->steps + 4 * row;
        const double *after = feet->steps + 4 * (row < last ? row + 1 : last);
        double progress = 0.0, height = 0.0, rolled = 0.0;
        if (phase[2] != 0.0) {
            const double end = swing[3], touching = feet->touching, over = after[2] - before[2] - swing[26];
            const double t = (feet->elapsed[k] - phase[3]) * feet->sample_time;
            const int falls = t >= swing[2] - touching;
            progress = polynomial(swing + 8, clamp(t - swing[0], 0.0, swing[1] - swing[0]));
            height = falls ? polynomial(swing + 20, t - swing[5]) : polynomial(swing + 14, t - swing[4]);
            if (t >= end - touching) progress = swing[6], height = swing[7];
            if (fabs(over) > feet->sunk) height += progress * over;
        }
        if (phase[6] != 0.0) {
            const double s = (feet->clock[k] - phase[4]) / (phase[5] - phase[4]), w = s * (1.0 - s);
            rolled = s > 0.0 && s < 1.0 ? phase[6] * (64.0 * w * w * w) : 0.0;
        }
        const int64_t right = phase[1] != 0.0, stands = right * feet->most + k, swings = (1 - right) * feet->most + k;
        for (int i = 0; i < 3; i++) {
            feet->soles[3 * stands + i] = stance[i];
            feet->soles[3 * swings + i] = before[i] + (i < 2 ? progress * (after[i] - before[i]) : height);
        }
        feet->heading[stands] = stance[3] - feet->heading_of_frame;
        feet->heading[swings] = before[3] + progress * (after[3] - before[3]) - feet->heading_of_frame;
        feet->pitch[stands] = 0.0;
        feet->pitch[swings] = rolled;
    }
}

/* Cosine and sine of rows of angles; those of an angle that stays are not made again. */
static void turn_row(const double *angles, int64_t count, double *restrict cosines, double *restrict sines) {
    cosines[0] = cos(angles[0]);
    sines[0] = sin(angles[0]);
    for (int64_t k = 1; k < count; k++) {
        const int stays = angles[k] == angles[k - 1];
        cosines[k] = stays ? cosines[k - 1] : cos(angles[k]);
        sines[k] = stays ? sines[k - 1] : sin(angles[k]);
    }
}

/* Counterpart of `_pitched`: a vector of a foot, pitched heel up by rows of angles, in the frames of its rows. */
static void pitched(const double *vector, double forward, double outward, const double *frame, const double *turn,
                    int64_t stride, int64_t count, double *restrict out) {
    const double *c = frame, *s = frame + stride, *cosine = turn, *sine = turn + stride;
    double *restrict ox = out, *restrict oy = out + stride, *restrict oz = out + 2 * stride;
    for (int64_t k = 0; k < count; k++) {
        const double x = forward + cosine[k] * vector[0] + sine[k] * vector[2], y = vector[1] + outward;
        ox[k] = x * c[k] - y * s[k];
        oy[k] = x * s[k] + y * c[k];
        oz[k] = cosine[k] * vector[2] - sine[k] * vector[0];
    }
}

/* Counterpart of `_headings` and of `LegChain._rolled`, in rows of scratch. */
static void place_frames(const LegOffset *legs, int64_t count) {
    const LegChain *chain = legs->chain;
    const double lever[3] = {chain->ankle[0] - legs->toe, chain->ankle[1], chain->ankle[2]};
    const double *left = legs->heading, *right = left + legs->most + 1;
    const int64_t stride = legs->stride;
    double *rows = legs->scratch, *turn = rows + stride * TURN, *mean = rows + stride * SPARE;
    for (int64_t k = 0; k < count; k++) mean[k] = 0.5 * (left[k] + right[k]);
    turn_row(mean, count, rows + stride * (FORWARD + 4), rows + stride * (FORWARD + 5));
    for (int leg = 0; leg < 2; leg++) {
        double *frame = rows + stride * (FORWARD + 2 * leg);
        const double outward = leg ? -chain->foot_outward : chain->foot_outward;
        turn_row(leg ? right : left, count, frame, frame + stride);
        turn_row(legs->pitch + leg * (legs->most + 1), count, turn, turn + stride);
        pitched(lever, legs->toe, 0.0, frame, turn, stride, count, rows + stride * (TO_ANKLE + 3 * leg));
        pitched(chain->foot_centre, 0.0, outward, frame, turn, stride, count, rows + stride * (TO_FOOT + 3 * leg));
    }
    for (int row = 0; row < RATE; row++)
        for (int64_t k = count; k < count + LANES - 1; k++) rows[stride * row + k] = rows[stride * row + count - 1];
}

/* Counterpart of `LegChain._hips`, of one leg; `c` and `s` are the trunk's heading. */
static void place_hips(const LegChain *chain, const Vectors *restrict middle, const Vectors *restrict ankle,
                       double side, const double *restrict c, const double *restrict s, Vectors *restrict hip) {
    const double half = side * chain->hip_half_width, beside = chain->hip_lever[0], above = chain->hip_lever[1];
    for (int l = 0; l < LANES; l++) {
        hip->x[l] = middle->x[l] - half * s[l];
        hip->y[l] = middle->y[l] + half * c[l];
        hip->z[l] = middle->z[l];
    }
    if (beside == 0.0 && above == 0.0) return;
    for (int l = 0; l < LANES; l++) {
        const double y = side * (c[l] * (ankle->y[l] - hip->y[l]) - s[l] * (ankle->x[l] - hip->x[l]));
        const double z = ankle->z[l] - hip->z[l], square = y * y + z * z, rest = square - beside * beside;
        const double down = sqrt(rest > 0.0 ? rest : 0.0), share = 1.0 / square;
        const double cosine = (y * beside - z * down) * share, sine = (z * beside + y * down) * share;
        const double out = side * (cosine * beside - sine * above);
        hip->x[l] -= out * s[l];
        hip->y[l] += out * c[l];
        hip->z[l] += sine * beside + cosine * above;
    }
}

/* Counterpart of `LegChain._bent`, of one leg. */
static void bend_knees(const LegChain *chain, const Vectors *restrict hip, const Vectors *restrict ankle,
                       const Vectors *restrict forward, Vectors *restrict knee) {
    const double a = chain->length[0], b = chain->length[1], whole = a + b, share_of_whole = 1.0 / whole;
    const double bend = chain->bend, least = chain->least_reach, unlike = a * a - b * b;
    for (int l = 0; l < LANES; l++) {
        const double x = ankle->x[l] - hip->x[l], y = ankle->y[l] - hip->y[l], z = ankle->z[l] - hip->z[l];
        const double length = sqrt(x * x + y * y + z * z), share = 1.0 / length, slack = 1.0 - length * share_of_whole;
        const double bowed = whole * (1.0 - 0.5 * (slack + sqrt(slack * slack + bend * bend)));
        const double reach = bowed > least ? bowed : least;
        const double along = 0.5 * (unlike / reach + reach);
        const double dx = share * x, dy = share * y, dz = share * z;
        const double falling = dx * forward->x[l] + dy * forward->y[l] + dz * forward->z[l];
        const double fx = forward->x[l] - falling * dx, fy = forward->y[l] - falling * dy;
        const double fz = forward->z[l] - falling * dz;
        const double beside = sqrt((a * a - along * along) / (fx * fx + fy * fy + fz * fz));
        knee->x[l] = hip->x[l] + along * dx + beside * fx;
        knee->y[l] = hip->y[l] + along * dy + beside * fy;
        knee->z[l] = hip->z[l] + along * dz + beside * fz;
    }
}

/* Counterpart of `LegChain._knees`, of one leg. */
static void place_knees(const LegChain *chain, const Vectors *restrict hip, const Vectors *restrict ankle,
                        const Vectors *restrict forward, Vectors *restrict knee) {
    bend_knees(chain, hip, ankle, forward, knee);
    if (!chain->rolls_first) return;
    Vectors axis;
    for (int l = 0; l < LANES; l++) {
        const double x = ankle->x[l] - knee->x[l], y = ankle->y[l] - knee->y[l], z = ankle->z[l] - knee->z[l];
        const double rising = x * forward->x[l] + y * forward->y[l];
        const double size = z * z * (forward->x[l] * forward->x[l] + forward->y[l] * forward->y[l]) + rising * rising;
        const double share = 1.0 / sqrt(size);
        axis.x[l] = -share * z * forward->x[l];
        axis.y[l] = -share * z * forward->y[l];
        axis.z[l] = share * rising;
    }
    bend_knees(chain, hip, ankle, &axis, knee);
}

static void store(const LegOffset *legs, int64_t point, int64_t first, const Vectors *vectors) {
    double *row = legs->points + 3 * legs->stride * point + first;
    memcpy(row, vectors->x, sizeof vectors->x);
    memcpy(row + legs->stride, vectors->y, sizeof vectors->y);
    memcpy(row + 2 * legs->stride, vectors->z, sizeof vectors->z);
}

/* Counterpart of what `LegChain._beside` adds to the points, of one link. */
static void store_beside(const LegOffset *legs, int64_t first, int link, const Vectors *restrict upper,
                         const Vectors *restrict lower, const Vectors *restrict forward) {
    const double ahead = legs->chain->ahead[link];
    for (int leg = 0; leg < 2; leg++) {
        const double outward = leg ? -legs->chain->outward[link] : legs->chain->outward[link];
        Vectors way;
        for (int l = 0; l < LANES; l++) {
            const double x = lower[leg].x[l] - upper[leg].x[l], y = lower[leg].y[l] - upper[leg].y[l];
            const double z = lower[leg].z[l] - upper[leg].z[l], c = forward[leg].x[l], s = forward[leg].y[l];
            way.x[l] = -ahead * z * c - outward * s;
            way.y[l] = -ahead * z * s + outward * c;
            way.z[l] = ahead * (x * c + y * s);
        }
        store(legs, (link ? BESIDE_SHANK : BESIDE_THIGH) + leg, first, &way);
    }
}

/* Counterpart of `LegChain._posture` and of what `LegChain.momentum_rate` does before it, from a sample on. */
static void place_points(const LegOffset *legs, int64_t first, int64_t last) {
    const LegChain *chain = legs->chain;
    const double *rows = legs->scratch + first, *c = rows + legs->stride * (FORWARD + 4), *s = c + legs->stride;
    Vectors ankle[2], hip[2], knee[2], forward[2], middle = {{0.0}, {0.0}, {0.0}}, fixed, foot;
    double own[3];
    for (int leg = 0; leg < 2; leg++) {
        const double *to_ankle = rows + legs->stride * (TO_ANKLE + 3 * leg);
        const double *to_foot = rows + legs->stride * (TO_FOOT + 3 * leg);
        const double *ahead = rows + legs->stride * (FORWARD + 2 * leg);
        for (int l = 0; l < LANES; l++) {
            const int64_t k = first + l < last ? first + l : last;
            const double *sole = legs->soles + 3 * (leg * (legs->most + 1) + k), *com = legs->com + 3 * k;
            ankle[leg].x[l] = sole[0] - com[0] + to_ankle[l];
            ankle[leg].y[l] = sole[1] - com[1] + to_ankle[legs->stride + l];
            ankle[leg].z[l] = sole[2] - com[2] + to_ankle[2 * legs->stride + l];
            foot.x[l] = ankle[leg].x[l] + to_foot[l];
            foot.y[l] = ankle[leg].y[l] + to_foot[legs->stride + l];
            foot.z[l] = ankle[leg].z[l] + to_foot[2 * legs->stride + l];
            forward[leg].x[l] = ahead[l];
            forward[leg].y[l] = ahead[legs->stride + l];
            forward[leg].z[l] = 0.0;
        }
        store(legs, ANKLE + leg, first, &ankle[leg]);
        store(legs, FOOT + leg, first, &foot);
    }
    for (int i = 0; i < 3; i++)
        own[i] = chain->trunk_mass * chain->trunk[i] + 2.0 * chain->foot_mass * chain->foot_centre[i];
    for (int l = 0; l < LANES; l++) {
        fixed.x[l] = chain->at_ankle * (ankle[0].x[l] + ankle[1].x[l]) + own[0] * c[l] - own[1] * s[l];
        fixed.y[l] = chain->at_ankle * (ankle[0].y[l] + ankle[1].y[l]) + own[0] * s[l] + own[1] * c[l];
        fixed.z[l] = chain->at_ankle * (ankle[0].z[l] + ankle[1].z[l]) + own[2];
        middle.z[l] = chain->guess;
    }
    for (int64_t round = 0;; round++) {
        for (int leg = 0; leg < 2; leg++) {
            place_hips(chain, &middle, &ankle[leg], leg ? -1.0 : 1.0, c, s, &hip[leg]);
            place_knees(chain, &hip[leg], &ankle[leg], &forward[leg], &knee[leg]);
        }
        if (round == chain->corrections) break;
        const double at_hip = chain->at_hip, at_knee = chain->at_knee, share = 1.0 / chain->carried;
        const double thigh = chain->mass_ahead[0], shank = chain->mass_ahead[1];
        for (int l = 0; l < LANES; l++) {
            const double hx = hip[0].x[l] + hip[1].x[l], hy = hip[0].y[l] + hip[1].y[l], hz = hip[0].z[l] + hip[1].z[l];
            const double kx = knee[0].x[l] + knee[1].x[l], ky = knee[0].y[l] + knee[1].y[l];
            const double kz = knee[0].z[l] + knee[1].z[l];
            const double bx = thigh * (kx - hx) + shank * (ankle[0].x[l] + ankle[1].x[l] - kx);
            const double by = thigh * (ky - hy) + shank * (ankle[0].y[l] + ankle[1].y[l] - ky);
            const double bz = thigh * (kz - hz) + shank * (ankle[0].z[l] + ankle[1].z[l] - kz);
            const double ex = fixed.x[l] + chain->trunk_mass * middle.x[l] + at_hip * hx + at_knee * kx - bz * c[l];
            const double ey = fixed.y[l] + chain->trunk_mass * middle.y[l] + at_hip * hy + at_knee * ky - bz * s[l];
            const double ez = fixed.z[l] + chain->trunk_mass * middle.z[l] + at_hip * hz + at_knee * kz;
            middle.x[l] -= share * ex;
            middle.y[l] -= share * ey;
            middle.z[l] -= share * (ez + bx * c[l] + by * s[l]);
        }
    }
    for (int leg = 0; leg < 2; leg++) {
        store(legs, HIP + leg, first, &hip[leg]);
        store(legs, KNEE + leg, first, &knee[leg]);
    }
    for (int l = 0; l < LANES; l++) {
        middle.x[l] += chain->trunk[0] * c[l] - chain->trunk[1] * s[l];
        middle.y[l] += chain->trunk[0] * s[l] + chain->trunk[1] * c[l];
        middle.z[l] += chain->trunk[2];
    }
    store(legs, TRUNK, first, &middle);
    if (chain->points <= BESIDE_THIGH) return;
    store_beside(legs, first, 0, hip, knee, forward);
    store_beside(legs, first, 1, knee, ankle, forward);
}

/* Counterpart of `_bend`, but for the square of the time, of one coordinate of a point. */
static void bend_row(const double *restrict points, double *restrict bends, double *restrict spare, int64_t count) {
    double *plain = count > 2 ? spare : bends;
    for (int64_t k = 0; k < count; k++) plain[k] = (points[k + 2] - points[k + 1]) - (points[k + 1] - points[k]);
    if (count <= 2) return;
    for (int64_t k = 1; k < count - 1; k++)
        bends[k] = spare[k] - ((spare[k + 1] - spare[k]) - (spare[k] - spare[k - 1])) * (1.0 / 12.0);
    bends[0] = spare[0] - (spare[1] - bends[1]);
    bends[count - 1] = spare[count - 1] - (spare[count - 2] - bends[count - 2]);
}

/* Counterpart of `_crossed`, of two points, added to rows. */
static void add_crossed(double mass, const double *restrict point, const double *restrict bend, int64_t stride,
                        int64_t count, double *restrict rate) {
    const double *x = point, *y = x + stride, *z = y + stride, *u = bend, *v = u + stride, *w = v + stride;
    double *restrict rx = rate, *restrict ry = rate + stride;
    for (int64_t k = 0; k < count; k++) {
        rx[k] += mass * (y[k] * w[k] - z[k] * v[k]);
        ry[k] += mass * (z[k] * u[k] - x[k] * w[k]);
    }
}

/* The CoM at all samples and at the one before them. */
static void place_com(const LegOffset *legs, int64_t samples) {
    const NominalMotion *motion = legs->motion;
    const double t = motion->sample_time, *height = legs->height;
    for (int axis = 0; axis < 2; axis++)
        legs->com[axis] = motion->com[axis] - motion->velocity[axis] * t + 0.5 * motion->acceleration[axis] * t * t -
                          motion->jerk[axis] * t * t * t / 6.0;
    legs->com[2] = height[0] - height[legs->most] * t + 0.5 * height[2 * legs->most] * t * t;
    for (int64_t k = 0; k < samples; k++) {
        double *com = legs->com + 3 * (k + 1);
        com[0] = motion->com[2 * k];
        com[1] = motion->com[2 * k + 1];
        com[2] = height[k];
    }
}

void leg_offset_make(const LegOffset *legs, int64_t samples, int64_t passes) {
    const NominalMotion *motion = legs->motion;
    const LegChain *chain = legs->chain;
    const int64_t last = samples - 1, stride = legs->stride, padded = (samples + LANES) / LANES * LANES;
    const double scale = 1.0 / (motion->sample_time * motion->sample_time);
    double *offset = legs->offset, *rate = legs->scratch + stride * RATE;
    place_frames(legs, samples + 1);
    for (int64_t pass = 0; pass < passes; pass++) {
        for (int64_t i = 0; i < 2 * samples; i++) legs->zmp[i] = legs->point[i] - offset[i];
        nominal_motion_make(motion, samples);
        place_com(legs, samples);
        for (int64_t first = 0; first < padded; first += LANES) place_points(legs, first, samples);
        for (int64_t row = 0; row < 3 * chain->points; row++)
            bend_row(legs->points + stride * row, legs->bends + stride * row, legs->scratch + stride * SPARE, last);
        memset(rate, 0, 2 * stride * sizeof(double));
        for (int64_t pair = 0; pair < chain->pair_count; pair++) {
            const int64_t *of = chain->pairs + 2 * pair;
            add_crossed(chain->pair_mass[pair] * scale, legs->points + 3 * stride * of[0] + 1,
                        legs->bends + 3 * stride * of[1], stride, last, rate);
        }
        for (int64_t k = 0; k < samples; k++) {
            const double pull = 1.0 / motion->stiffness[k] - 1.0 / legs->stiffness[k];
            for (int axis = 0; axis < 2; axis++) offset[2 * k + axis] = pull * motion->acceleration[2 * k + axis];
        }
        for (int64_t k = 0; k < last; k++) {
            const double pressing = legs->gravity + legs->height[2 * legs->most + k];
            offset[2 * k] -= rate[stride + k] / pressing;
            offset[2 * k + 1] += rate[k] / pressing;
        }
        memcpy(offset + 2 * last, offset + 2 * last - 2, 2 * sizeof(double));
    }
}
