/* What of a push is still captured, and the next step that captures it; see `planner.recovery`. */
#include "algebra.h"
#include "kernels.h"

static const double peak = 5.77, braking = 1.9, gaining = 3.9; /* of `planner.swing.leg_reach` */
static const double no_gain = 1e-9;

enum { BOXES = 3 };

/* Lower and upper corner of where a foot may land, then whether it is empty. */
typedef struct {
    double low[2];
    double high[2];
    int64_t empty;
} Box;

static double square(double x) { return x * x; }

/* Counterpart of `planner.model.dcm.decays`. */
void outlook_decay(const Outlook *ahead) {
    double sum = 0.0, before = ahead->stiffness[0] / ahead->omega[0];
    ahead->decay[0] = 1.0;
    for (int64_t k = 1; k < ahead->count; k++) {
        const double rate = ahead->stiffness[k] / ahead->omega[k];
        sum += rate + before;
        before = rate;
        ahead->decay[k] = exp(-0.5 * ahead->sample_time * sum);
    }
}

/* Counterpart of `planner.recovery.capture_margin.planned_margin`. */
double outlook_margin(const Outlook *ahead, double x, double y, double foot_margin) {
    const int64_t last = ahead->count - 1;
    const double *decay = ahead->decay, dcm[2] = {x, y};
    double point[2] = {0.0}, half[2] = {0.0}, margin = INFINITY;
    for (int64_t k = 0; k <= last; k++) {
        const double before = k > 0 ? 0.5 * (decay[k - 1] - decay[k]) : 0.0;
        const double weight = before + (k < last ? 0.5 * (decay[k] - decay[k + 1]) : decay[k]);
        for (int i = 0; i < 2; i++) {
            point[i] += weight * ahead->point[2 * k + i];
            half[i] += weight * ahead->half_size[2 * k + i];
        }
    }
    for (int i = 0; i < 2; i++) margin = fmin(margin, half[i] / foot_margin - fabs(dcm[i] - point[i]));
    return margin;
}

/* Counterpart of `planner.swing.leg_reach.LegReach.allowed` of legs that are turned; says how many boxes there are. */
static int64_t allowed(const Legs *legs, const Landing *step, Box *boxes) {
    const double most = 2.0 * legs->radius, far = step->side * (most + legs->hip_width);
    const double back[BOXES] = {-most, step->clear, -most}, ahead[BOXES] = {most, most, -step->clear};
    const int64_t count = step->crosses != 0.0 && legs->crosses ? BOXES : 1;
    for (int64_t b = 0; b < count; b++) {
        const double near = step->side * (b ? -legs->across : step->near);
        boxes[b].low[0] = fmax(back[b], step->face[0]);
        boxes[b].low[1] = fmax(fmin(near, far), step->face[1]);
        boxes[b].high[0] = fmin(ahead[b], step->face[2]);
        boxes[b].high[1] = fmin(fmax(near, far), step->face[3]);
        boxes[b].empty = boxes[b].low[0] > boxes[b].high[0] || boxes[b].low[1] > boxes[b].high[1];
    }
    return count;
}

static double swing_time(const Legs *legs, double single) {
    return fmax(single - legs->touchdown_lead, legs->sample_time);
}

/* Counterpart of `planner.swing.leg_reach.LegReach.edges`, for one time left of the swing. */
static void swung_to(const Legs *legs, const Landing *step, double single, double *edges) {
    const double time = swing_time(legs, single), usual = swing_time(legs, step->single_left);
    for (int i = 0; i < 2; i++) {
        const double at = step->swing[i], speed = step->swing[2 + i];
        const double nominal = peak * (step->nominal[i] - at) / (usual * usual) - braking * speed / usual;
        const double hardest = fmax(legs->acceleration[i], fabs(nominal));
        for (int back = 0; back < 2; back++) {
            const double side = back ? -1.0 : 1.0, onward = side * speed;
            const double gained = (onward > 0.0 ? braking : gaining) * onward;
            edges[2 * back + i] = side * at + (hardest * time * time + gained * time) / peak;
        }
    }
}

/* Counterpart of `planner.recovery.capture_margin.CaptureMargin.landed`; four edges after each count of steps. */
static void landed(const Capture *capture, double growth, double side, int64_t count) {
    const double k = 1.0 / growth;
    for (int64_t m = 0; m < count; m++) {
        const double power = pow(k, (double)m), turned = m % 2 ? -power : power;
        const double wide = k / (1.0 - k) * (1.0 - power), off = side * k / (1.0 + k) * (1.0 - turned);
        for (int e = 0; e < 4; e++)
            capture->captured[4 * m + e] = capture->half[e] + wide * capture->apart[e] + off * capture->middle[e];
    }
}

/* What of one time of the present step is captured with so many steps more, over all boxes. */
static void margins_at(const Capture *capture, const Box *boxes, int64_t box_count, double double_left,
                       double single_left, int64_t steps, int64_t fixed) {
    const Landing *step = capture->step;
    const Legs *legs = capture->legs;
    const double omega = step->omega, single = exp(omega * single_left), doubled = exp(omega * double_left);
    const double growth = step->double_left != 0.0 ? doubled * single : single, shrunk = 1.0 / growth;
    const double spread = 2.0 / (growth + shrunk), by = 2.0 / fmax(growth - shrunk, 1e-9);
    double swung[4], away[4], under[4], here[4];
    if (!fixed) swung_to(legs, step, single_left, swung);
    for (int e = 0; e < 4; e++) {
        const double sign = e < 2 ? 1.0 : -1.0, half = capture->half[e];
        double com = sign * step->com[e % 2];
        here[e] = sign * step->dcm[e % 2];
        away[e] = (1.0 - single) * half;
        com += 0.5 * (single - 1.0) * away[e];
        if (step->double_left != 0.0) {
            const double first = half + fmax(sign * step->swing[e % 2], 0.0);
            com += 0.5 * (doubled - 1.0) * ((single - 1.0) * away[e] - (growth * single - 1.0) * first);
            away[e] += single * (1.0 - doubled) * first;
        }
        under[e] = com / growth + step->side * (e % 2 ? sign * 0.5 * legs->hip_width : 0.0);
    }
    for (int64_t b = 0; b < box_count; b++) {
        double ahead[4], spanned[4], nearest[4];
        for (int e = 0; e < 4; e++) {
            const double sign = e < 2 ? 1.0 : -1.0, box = e < 2 ? boxes[b].high[e % 2] : -boxes[b].low[e % 2];
            const double place = fixed ? sign * step->nominal[e % 2] : fmin(box, swung[e]);
            ahead[e] = (place - away[e]) * shrunk - here[e];
            spanned[e] = (legs->radius + under[e] - away[e]) * spread - here[e];
            nearest[e] = (place + (legs->radius - under[e])) * by - here[e];
        }
        for (int64_t m = 0; m < steps; m++) {
            double least = INFINITY;
            for (int e = 0; e < 4; e++) {
                const double captured = capture->captured[4 * m + e];
                double margin = ahead[e] + captured * shrunk;
                if (!fixed) margin = fmin(fmin(margin, spanned[e] + captured * spread), nearest[e]);
                if (m == 0) margin = fmax(margin, (capture->half[e] - away[e]) * shrunk - here[e]);
                least = fmin(least, margin);
            }
            capture->margins[m] = fmax(capture->margins[m], least);
        }
    }
}

/* Counterpart of `planner.recovery.capture_margin.CaptureMargin.margins`. */
void capture_margins(const Capture *capture, int64_t steps, int64_t fixed) {
    const Landing *step = capture->step;
    const double cycle = capture->timing ? fmin(capture->cycle, step->cycle) : step->cycle;
    const double least = fmin(step->single_left, fmax(capture->least_single, step->shortest));
    const double most = step->single_left + capture->longer;
    const double doubles[2] = {fmin(step->double_left, capture->least_double), step->double_left};
    Box boxes[BOXES] = {{{0.0}, {0.0}, 0}};
    const int64_t count = fixed ? 1 : allowed(capture->legs, step, boxes);
    const int64_t choices = fixed || !capture->timing ? 0 : capture->time_count;
    for (int64_t m = 0; m < steps; m++) capture->margins[m] = -INFINITY;
    landed(capture, exp(step->omega * cycle), -step->side, steps);
    for (int64_t d = choices && step->double_left != 0.0 ? 0 : 1; d < 2; d++) {
        for (int64_t k = 0; k <= choices; k++) {
            const double single = k < choices ? least + capture->times[k] * (most - least) : step->single_left;
            margins_at(capture, boxes, count, doubles[d], single, steps, fixed);
        }
    }
    for (int64_t m = 1; m < steps; m++) capture->margins[m] = fmax(capture->margins[m], capture->margins[m - 1]);
}

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
static int64_t times_around(const Adjustment *program, double time, double least, double *times) {
    int64_t count = 0;
    for (int64_t k = 0; k < program->change_count; k++) {
        const double changed = time + program->changes[k];
        if (changed >= fmin(time, least)) times[count++] = changed;
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
        single_count = times_around(program, step->single_left, least, singles);
        if (step->double_left != 0.0)
            double_count = times_around(program, step->double_left, program->least_double, doubles);
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
    const double radius = program->legs->radius;
    for (int i = 0; i < 2; i++) {
        const double place = choice.place[i], held = bounded->held[i], other = choice.place[1 - i] - choice.hips[1 - i];
        const double most = sqrt(fmax(radius * radius - other * other, 0.0));
        double low = choice.low[i], high = choice.high[i];
        if (way == 0) {
            const double left = fmax(program->landing_share * held, held / program->cop_share - program->landing_spare);
            low = fmax(low, choice.wanted[i] - left / bounded->gain);
            high = fmin(high, choice.wanted[i] + left / bounded->gain);
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
int64_t adjustment_solve(const Adjustment *program) {
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
        fine &= fabs(step->dcm[i] - now[i]) <= (1.0 - fade) * own + bounded.more[i] + missed;
    }
    if (fine && step->adapted == 0.0) return 0;
    return cheapest(program, &bounded, fine);
}
