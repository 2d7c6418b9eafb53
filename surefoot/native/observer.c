/* What lasts of an external force, out of spans of time; see `wbc.external`. What the planner is told of the feet. */
#include "algebra.h"
#include "kernels.h"

/* Numbers of an estimate: force x, y; moment x, y, z; share of the weight. */
enum { NUMBERS = 6, PULLS = 5, MOST_SPANS = 64 };

static void moving(const Terms *terms, double *momentum) {
    double turning[3];
    for (int i = 0; i < 3; i++) momentum[i] = terms->model_mass * terms->com_velocity[i];
    cross(terms->com, momentum, turning);
    for (int i = 0; i < 3; i++) momentum[3 + i] = terms->angular_momentum[i] + turning[i];
}

/* Momentum and moment of momentum about the origin now, where the first span begins. */
void load_moving(const LoadSpan *span) {
    const LoadSums *sums = span->sums;
    moving(sums->terms, span->momentum);
    for (int64_t k = 0; k < sums->past_count; k++) memcpy(sums->past + 6 * k, span->momentum, 6 * sizeof(double));
}

/* Counterpart of `LoadObserver.update` within a span. */
void load_sums_add(const LoadSums *sums) {
    const double *map = sums->terms->sole_wrench_map;
    for (int i = 0; i < 6; i++) {
        double felt = 0.0;
        for (int j = 0; j < 12; j++) felt += map[12 * i + j] * sums->wrench[j];
        sums->felt[i] += felt;
    }
    for (int i = 0; i < 3; i++) sums->com[i] += sums->terms->com[i];
    sums->newest[0] = (sums->newest[0] + 1) % sums->past_count;
    moving(sums->terms, sums->past + 6 * sums->newest[0]);
}

/* Momenta as they were when the forces acted that the soles tell of now: counterpart of `LoadObserver._then`. */
static void moved(const LoadSums *sums, double late, double *momentum) {
    const int64_t whole = (int64_t)late, newest = sums->newest[0] + sums->past_count - whole;
    const double *younger = sums->past + 6 * (newest % sums->past_count);
    const double *older = sums->past + 6 * ((newest - 1) % sums->past_count);
    for (int i = 0; i < 6; i++) momentum[i] = younger[i] + (late - whole) * (older[i] - younger[i]);
}

/* Values of which nothing counts up to the first limit, all from the second one on. */
static double ramp(double value, double none, double full) {
    return value * clamp((fabs(value) - none) / (full - none), 0.0, 1.0);
}

/* Median of a number over the last spans, as sorting finds it. */
static double median(const LoadSpan *span, int64_t number, int64_t count) {
    const int64_t filled = span->filled[0], spans = count < filled ? count : filled;
    double sorted[MOST_SPANS];
    for (int64_t k = 0; k < spans; k++) {
        const double value = span->spans[NUMBERS * (filled - spans + k) + number];
        int64_t place = k;
        for (; place > 0 && sorted[place - 1] > value; place--) sorted[place] = sorted[place - 1];
        sorted[place] = value;
    }
    return sorted[spans / 2];
}

/* Counterpart of `LoadObserver._follow`. */
static void follow(const LoadSpan *span) {
    double lasting[NUMBERS], latest[NUMBERS], wanted[NUMBERS] = {0.0};
    for (int i = 0; i < NUMBERS; i++) {
        lasting[i] = median(span, i, span->spans_count);
        latest[i] = median(span, i, span->latest_count);
    }
    const double none = span->push[0], full = span->push[1];
    const int64_t first = span->filled[0] > span->latest_count ? span->filled[0] - span->latest_count : 0;
    double hardest = 0.0;
    for (int64_t k = first; k < span->filled[0]; k++)
        hardest = fmax(hardest, hypot(span->spans[NUMBERS * k], span->spans[NUMBERS * k + 1]));
    const double counts = clamp((full - hardest) / (full - none), 0.0, 1.0);
    for (int i = 0; i < PULLS && span->filled[0] == span->spans_count; i++) {
        const double least = fabs(lasting[i]) < fabs(latest[i]) ? fabs(lasting[i]) : fabs(latest[i]);
        const double both = lasting[i] * latest[i] > 0.0 ? least : 0.0;
        const double kept = ramp(copysign(both, latest[i]), span->kept[i], span->kept[PULLS + i]);
        double sudden = ramp(latest[i], span->sudden[i], span->sudden[PULLS + i]);
        sudden = clamp(sudden, -span->bound[i], span->bound[i]) * counts;
        wanted[i] = fabs(sudden) > fabs(kept) ? sudden : kept;
    }
    wanted[PULLS] = ramp(clamp(lasting[PULLS], -span->most_share, span->most_share), span->share_limits[0],
                         span->share_limits[1]);
    for (int i = 0; i < NUMBERS; i++) {
        const double most = span->most_change[i];
        span->estimate[i] += clamp(wanted[i] - span->estimate[i], -most, most);
    }
}

/* Holds the forces of a span, late by so many ticks, against its change of momentum; says whether it found a load. */
static int end_span(const LoadSpan *span, double late) {
    const LoadSums *sums = span->sums;
    double felt[6], com[3], now[6], change[6], turning[3], found[NUMBERS];
    moved(sums, late, now);
    /* By how much the CoM was farther back when the forces acted, in the time of a momentum. */
    const double back = 0.5 * late * span->span / (span->ticks * sums->terms->model_mass);
    for (int i = 0; i < 3; i++) {
        com[i] = sums->com[i] / span->ticks - back * (span->momentum[i] + now[i]);
        sums->com[i] = 0.0;
    }
    for (int i = 0; i < 6; i++) {
        felt[i] = sums->felt[i] / span->ticks;
        change[i] = (now[i] - span->momentum[i]) / span->span;
        span->momentum[i] = now[i];
        sums->felt[i] = 0.0;
    }
    const double pressing = change[2] + span->weight, least = span->least_press * span->weight;
    const int known = pressing > least && felt[2] > least;
    const double scale = known ? felt[2] / pressing : 1.0 + span->estimate[PULLS];
    const double pull[3] = {scale * change[0] - felt[0], scale * change[1] - felt[1], -scale * span->weight};
    cross(com, pull, turning);
    found[0] = pull[0];
    found[1] = pull[1];
    for (int i = 0; i < 3; i++) found[2 + i] = scale * change[3 + i] - felt[3 + i] - turning[i];
    found[PULLS] = scale - 1.0;
    for (int i = 0; i < NUMBERS; i++)
        if (!isfinite(found[i])) return 0;
    if (span->filled[0] == span->spans_count)
        memmove(span->spans, span->spans + NUMBERS, (span->spans_count - 1) * NUMBERS * sizeof(double));
    else
        span->filled[0]++;
    memcpy(span->spans + NUMBERS * (span->filled[0] - 1), found, sizeof found);
    return 1;
}

static int is_any(const double *estimate) {
    for (int i = 0; i < NUMBERS; i++)
        if (estimate[i] != 0.0) return 1;
    return 0;
}

/*
 * Counterpart of `LoadObserver.update` at the end of a span, whose wrenches are so old in all [s].
 *
 * Returns whether the estimate may be another one: it is nothing where it was nothing in most spans.
 */
int64_t load_span_end(const LoadSpan *span, double age) {
    load_sums_add(span->sums);
    const int found = end_span(span, clamp(age / span->span, 0.0, span->sums->past_count - 2.0));
    if (!span->known[0]) {
        span->waits[0] = 1;
        span->filled[0] = 0;
    }
    if (!found || !span->known[0] || (span->waits[0] && span->filled[0] < span->spans_count)) return 0;
    const int was_any = is_any(span->estimate);
    follow(span);
    return was_any || is_any(span->estimate);
}

/* Where the soles' centres would be if each foot turned level about its toe edge, their yaws, and the ZMP. */
void feet_see(const FeetSeen *feet, double toe) {
    const Terms *terms = feet->terms;
    double force[2][3], torque[2][3], total = 0.0, height = 0.0, x = 0.0, y = 0.0;
    for (int k = 0; k < 2; k++) {
        const double *R = terms->sole_rotation + 9 * k, *position = terms->sole_position + 3 * k;
        const double ahead[3] = {R[0], R[3], R[6]}, size = hypot(ahead[0], ahead[1]);
        const double flat = 1.0 / (size > 1e-9 ? size : 1e-9);
        for (int i = 0; i < 3; i++)
            feet->level[3 * k + i] = position[i] + toe * (ahead[i] - (i < 2 ? ahead[i] * flat : 0.0));
        feet->yaw[k] = atan2(ahead[1], ahead[0]);
        rotate(R, feet->wrench + 6 * k, force[k]);
        rotate(R, feet->wrench + 6 * k + 3, torque[k]);
        total += force[k][2];
        height += force[k][2] * position[2];
    }
    if (total < feet->unloaded) total = NAN;
    height /= total;
    for (int k = 0; k < 2; k++) {
        const double *position = terms->sole_position + 3 * k, lever = position[2] - height;
        x += torque[k][0] + position[1] * force[k][2] - lever * force[k][1];
        y += torque[k][1] + lever * force[k][0] - position[0] * force[k][2];
    }
    feet->zmp[0] = -y / total;
    feet->zmp[1] = x / total;
    feet->zmp[2] = height;
}
