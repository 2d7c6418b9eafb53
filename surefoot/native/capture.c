/* What of a push is still captured; see `planner.recovery.capture_margin`. */
#include "reach.h"

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

/* Mean of pairs of values ahead by the weights of `planner.model.dcm.viability_weights`. */
static void weigh(const Outlook *ahead, const double *values, double *mean) {
    const int64_t last = ahead->count - 1;
    const double *decay = ahead->decay;
    mean[0] = mean[1] = 0.0;
    for (int64_t k = 0; k <= last; k++) {
        const double before = k > 0 ? 0.5 * (decay[k - 1] - decay[k]) : 0.0;
        const double weight = before + (k < last ? 0.5 * (decay[k] - decay[k + 1]) : decay[k]);
        for (int i = 0; i < 2; i++) mean[i] += weight * values[2 * k + i];
    }
}

/* The first DCM of `planner.model.dcm.nominal_dcm`. */
void outlook_nominal(const Outlook *ahead, int64_t fresh) {
    if (fresh) outlook_decay(ahead);
    weigh(ahead, ahead->point, ahead->nominal);
}

/* Counterpart of `planner.recovery.capture_margin.planned_margin`. */
double outlook_margin(const Outlook *ahead, double x, double y, double foot_margin, int64_t fresh) {
    const double dcm[2] = {x, y};
    double point[2], half[2], margin = INFINITY;
    if (fresh) outlook_decay(ahead);
    weigh(ahead, ahead->point, point);
    weigh(ahead, ahead->half_size, half);
    for (int i = 0; i < 2; i++) margin = fmin(margin, half[i] / foot_margin - fabs(dcm[i] - point[i]));
    return margin;
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
