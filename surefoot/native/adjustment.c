/* The next step that captures a push; see `planner.recovery.step_adjustment`. */
#include "reach.h"

static const double no_gain = 1e-9;

static double square(double x) { return x * x; }

/* Counterpart of `planner.swing.leg_reach.LegReach.shortfall`, of one place and time. */
static double shortfall(const Legs *legs, const Landing *step, double single, const double *place) {
    const double *here = step->swing, *speed = step->swing + 2, side = step->side;
    const double crossing = side * here[1] < 0.0 ? here[0] : side * place[1] < 0.0 ? place[0] : 0.0;
    if (crossing == 0.0) return 0.0;
    const int64_t count = legs->shares;
    const double *ways = legs->at_rest, *moves = legs->moving, *bends = ways + count, *turns = moves + count;
    const double time = swing_time(legs, single), corner[2] = {copysign(step->clear, crossing), side * step->near};
    double way[2], onward[2], astray[2] = {0.0}, dearest = INFINITY, hardest = 1.0;
    int64_t met = 0, best = 0;
    for (int i = 0; i < 2; i++) {
        way[i] = place[i] - here[i];
        onward[i] = speed[i] * time;
    }
    for (int64_t j = 0; j < count; j++) {
        double passed[2];
        for (int i = 0; i < 2; i++) passed[i] = here[i] + way[i] * ways[j] + onward[i] * moves[j];
        met |= fabs(passed[0]) < step->clear && side * passed[1] < step->near;
        const double cost = (square(corner[0] - passed[0]) + square(corner[1] - passed[1])) / legs->dearer[j];
        if (cost < dearest) {
            dearest = cost;
            best = j;
            for (int i = 0; i < 2; i++) astray[i] = corner[i] - passed[i];
        }
    }
    if (!met) return 0.0;
    for (int64_t j = 0; j < count; j++) {
        for (int i = 0; i < 2; i++) {
            const double bend = way[i] * bends[j] + onward[i] * turns[j] + astray[i] * legs->around[count * best + j];
            hardest = fmax(hardest, fabs(bend) / (time * time * legs->acceleration[i]));
        }
    }
    return (1.0 - 1.0 / hardest) * hypot(way[0], way[1]);
}

/* Counterpart of `planner.model.dcm.moving_cop`, of one axis. */
static double moving_cop(double start, double end, double omega, double time) {
    const double growth = exp(omega * time) - 1.0;
    return growth * start + (growth / (omega * time) - 1.0) * (end - start);
}

/* Counterpart of `planner.model.dcm.pendulum_com`, of one axis. */
static double pendulum_com(double com, double dcm, double cop, double growth) {
    return com / growth + cop * (1.0 - 1.0 / growth) + 0.5 * (dcm - cop) * (growth - 1.0 / growth);
}

/* What the program has of the DCM: what the steps as planned keep bounded, and what the CoP holds of a miss. */
typedef struct {
    double present[2];
    double lift_off[2];
    double landed[2];
    double gain;
    double more[2];
    double held[2];
} Bounded;

/* A step at one time in one box, and what it costs. */
typedef struct {
    double wanted[2];
    double low[2];
    double high[2];
    double hips[2];
    double place[2];
    double second[2];
    double cost;
} Choice;

/* The place nearest to one, or the upper end where there is none. */
static double between(double place, double low, double high) { return fmin(fmax(place, low), high); }

/* Counterpart of `planner.recovery.step_adjustment._landing`: p* and the CoM at the landing. */
static void land(const Adjustment *program, const Bounded *bounded, double double_left, double single_left,
                 double *wanted, double *com) {
    const Landing *step = program->step;
    const double omega = step->omega, spread = exp(omega * double_left), grown = exp(omega * single_left);
    const double single = exp(omega * step->single_left), nominal = exp(omega * step->double_left);
    for (int i = 0; i < 2; i++) {
        const double centre = (bounded->landed[i] - single * bounded->lift_off[i]) / (1.0 - single);
        const double half = bounded->held[i], more = program->cop_share * bounded->more[i], dcm = step->dcm[i];
        double lifted = dcm, start = centre;
        if (step->double_left != 0.0) {
            start = program->ahead->point[i];
            const double moved = moving_cop(start, centre, omega, step->double_left);
            const double beside = nominal * bounded->present[i] - moved - bounded->lift_off[i];
            lifted = spread * dcm - moving_cop(start, centre, omega, double_left);
            lifted -= (spread - 1.0) * (beside / (nominal - 1.0));
        }
        const double astray = grown * (lifted - centre) + centre - bounded->landed[i];
        const double most = (grown * spread - 1.0) * half + grown * spread * more, held = between(astray, -most, most);
        const double cop = centre + half * held / fmax(most, 1e-9);
        const double there = step->double_left != 0.0 ? pendulum_com(step->com[i], dcm, 0.5 * (start + cop), spread)
                                                      : step->com[i];
        wanted[i] = step->nominal[i] + (astray - held) / bounded->gain;
        com[i] = pendulum_com(there, lifted, cop, grown);
    }
}

/* Counterpart of the cost in `planner.recovery.step_adjustment.StepAdjustment._cheapest`. */
static void choose(const Adjustment *program, const Bounded *bounded, const Box *box, double double_left,
                   double single_left, Choice *choice) {
    const Landing *step = program->step;
    const Legs *legs = program->legs;
    const double *stand = program->ahead->half_size + 2 * (program->ahead->count - 1);
    const double growth = exp(step->omega * step->cycle), aside[2] = {0.0, 0.5 * step->side * legs->hip_width};
    double edges[4], com[2], way[2], cost = 0.0;
    land(program, bounded, double_left, single_left, choice->wanted, com);
    swung_to(legs, step, single_left, edges);
    for (int i = 0; i < 2; i++) {
        choice->low[i] = -edges[2 + i];
        choice->high[i] = edges[i];
        choice->hips[i] = com[i] + aside[i];
        const double swung = between(choice->wanted[i], choice->low[i], choice->high[i]);
        way[i] = between(swung, box->low[i], box->high[i]) - choice->hips[i];
    }
    const double share = fmin(1.0, legs->radius / fmax(hypot(way[0], way[1]), 1e-9));
    for (int i = 0; i < 2; i++) {
        const double place = between(choice->hips[i] + share * way[i], box->low[i], box->high[i]);
        const double off = choice->wanted[i] - place;
        const double next = step->last != 0.0 ? growth * program->stand_share * stand[i]
                                              : (growth - 1.0) * bounded->held[i];
        choice->place[i] = place;
        choice->second[i] = fmax(bounded->gain * growth * fabs(off) - next, 0.0);
        if (i == 1 && step->side * off > 0.0) choice->second[i] *= program->cross_factor;
        cost += program->shift_weight * square(place - step->nominal[i]);
        cost += program->second_weight * square(choice->second[i]);
        cost += program->swing_weight * square(place - between(place, choice->low[i], choice->high[i]));
    }
    const double changed = square(double_left - step->double_left) + square(single_left - step->single_left);
    const double stretch = fmax(hypot(com[0] - aside[0], com[1] - aside[1]) - legs->radius, 0.0);
    cost += program->time_weight * changed / square(step->cycle) + program->stretch_weight * square(stretch);
    cost += program->swing_weight * square(shortfall(legs, step, single_left, choice->place));
    choice->cost = box->empty ? INFINITY : cost;
}

/* Counterpart of `planner.recovery.step_adjustment.StepAdjustment._around`: says how many. */
static int64_t times_around(const Adjustment *program, double time, double least, double most, double *times) {
    int64_t count = 0;
    for (int64_t k = 0; k < program->change_count; k++) {
        const double changed = fmin(time, least + program->longest_cut) + program->changes[k];
        if (changed >= fmin(time, least) && changed <= most) times[count++] = changed;
    }
    times[count++] = time;
    return count;
}

/* Counterpart of `planner.recovery.step_adjustment.StepAdjustment._cheapest`; 1 where there is a place to land. */
static int64_t cheapest(const Adjustment *program, const Bounded *bounded, int64_t fine) {
    const Landing *step = program->step;
    double *doubles = program->times, *singles = doubles + program->change_count + 1;
    int64_t double_count = 1, single_count = 1, way = 0;
    doubles[0] = step->double_left;
    singles[0] = step->single_left;
    if (!fine && program->timing) {
        const double least = fmax(program->least_single, step->shortest);
        single_count = times_around(program, step->single_left, least, INFINITY, singles);
        const double left = step->double_left, most = step->adapted != 0.0 ? left : INFINITY;
        if (left != 0.0) double_count = times_around(program, left, program->least_double, most, doubles);
    }
    Box boxes[BOXES];
    Choice choice;
    double at[2] = {0.0}, least_cost = INFINITY;
    const int64_t box_count = allowed(program->legs, step, boxes);
    for (int64_t b = 0; b < box_count; b++) {
        double cost = INFINITY, times[2] = {0.0};
        for (int64_t d = 0; d < double_count; d++) {
            for (int64_t s = 0; s < single_count; s++) {
                choose(program, bounded, boxes + b, doubles[d], singles[s], &choice);
                if (choice.cost < cost) {
                    cost = choice.cost;
                    times[0] = doubles[d];
                    times[1] = singles[s];
                }
            }
        }
        /* The last ones are those planned. */
        if (!(cost < choice.cost - program->least_saving)) {
            cost = choice.cost;
            times[0] = step->double_left;
            times[1] = step->single_left;
        }
        if (cost < least_cost) {
            least_cost = cost;
            way = b;
            memcpy(at, times, sizeof at);
        }
    }
    if (least_cost == INFINITY) return 0;
    choose(program, bounded, boxes + way, at[0], at[1], &choice);
    program->result[0] = step->double_left != 0.0 ? at[0] : at[1];
    program->result[5] = choice.second[0] != 0.0 || choice.second[1] != 0.0;
    program->result[6] = choice.cost;
    const double radius = program->legs->radius;
    for (int i = 0; i < 2; i++) {
        const double place = choice.place[i], held = bounded->held[i], other = choice.place[1 - i] - choice.hips[1 - i];
        const double most = sqrt(fmax(radius * radius - other * other, 0.0));
        double low = choice.low[i], high = choice.high[i];
        const double wanted = choice.wanted[i];
        if (way == 0 || (wanted >= boxes[way].low[i] && wanted <= boxes[way].high[i])) {
            const double left = fmax(program->landing_share * held, held / program->cop_share - program->landing_spare);
            low = fmax(low, wanted - left / bounded->gain);
            high = fmin(high, wanted + left / bounded->gain);
        }
        const double least = fmin(fmax(boxes[way].low[i], choice.hips[i] - most), place);
        const double greatest = fmax(fmin(boxes[way].high[i], choice.hips[i] + most), place);
        program->result[1 + i] = fmax(least, fmin(low, place));
        program->result[3 + i] = fmin(greatest, fmax(high, place));
    }
    return 1;
}

/* Counterpart of `planner.model.dcm.nominal_dcm` for the columns of `StepAdjustment.solve`, at three samples. */
static void nominal_dcm(const Outlook *ahead, int64_t lift, int64_t lands, double *now, double *off, double *there) {
    const int64_t last = ahead->count - 1;
    const double *decay = ahead->decay, *box = ahead->half_size + 2 * lift;
    double sum[5] = {0.0}, next[5] = {0.0};
    for (int64_t k = last; k >= 0; k--) {
        const double *point = ahead->point + 2 * k, *half = ahead->half_size + 2 * k;
        const double wider = k < lift ? 1.0 : 0.0, share = k < last ? 0.5 * (decay[k] - decay[k + 1]) : decay[last];
        const double one[5] = {point[0], point[1], ahead->gain[2 * k], wider * (half[0] - box[0]),
                               wider * (half[1] - box[1])};
        for (int i = 0; i < 5; i++) {
            sum[i] += share * (one[i] + next[i]);
            next[i] = one[i];
        }
        double *at = k == 0 ? now : k == lift ? off : k == lands ? there : NULL;
        for (int i = 0; at && i < 5; i++) at[i] = sum[i] / decay[k];
        if (k == 0 && lift == 0) memcpy(off, now, sizeof sum);
    }
}

/* Counterpart of `planner.recovery.step_adjustment.StepAdjustment.solve`; 0 where that is None. */
int64_t adjustment_solve(const Adjustment *program, double unsure) {
    const Landing *step = program->step;
    const Outlook *ahead = program->ahead;
    const double t = ahead->sample_time, left = rint(step->double_left / t);
    const int64_t lift = left < (double)(ahead->count - 3) ? (int64_t)left : ahead->count - 3;
    const double until = fmin(rint((step->double_left + step->single_left) / t), (double)(ahead->count - 2));
    int64_t lands = (int64_t)until > lift + 1 ? (int64_t)until : lift + 1, fine = 1;
    if (lands > ahead->count - 2) lands = ahead->count - 2;
    double now[5], off[5], there[5];
    Bounded bounded;
    nominal_dcm(ahead, lift, lands, now, off, there);
    bounded.gain = fmax(there[2], no_gain);
    const double fade = ahead->decay[lands];
    for (int i = 0; i < 2; i++) {
        const double box = ahead->half_size[2 * lift + i], own = fmin(box, program->authority[i]);
        const double missed = fade * (own < box ? program->unheld_share * box : program->tolerance);
        bounded.present[i] = now[i];
        bounded.lift_off[i] = off[i];
        bounded.landed[i] = there[i];
        bounded.more[i] = now[3 + i];
        bounded.held[i] = program->cop_share * own;
        fine &= fabs(step->dcm[i] - now[i]) <= (1.0 - fade) * own + bounded.more[i] + missed + unsure;
    }
    if (fine && step->adapted == 0.0) return 0;
    return cheapest(program, &bounded, fine);
}
