/*
 * What Python and C share: structs of numbers and pointers, and the functions that work on them.
 *
 * `surefoot.native.library` reads this file, so that each struct is told once. Therefore: one field a line, each an
 * int64_t, a double, an array of doubles, or a pointer to double, int64_t or a struct above; functions take one struct
 * pointer, then int64_t or double. Python allocates all memory; matrices lie row by row unless a name says "columns".
 * Sizes come at run time.
 */
#ifndef SUREFOOT_KERNELS_H
#define SUREFOOT_KERNELS_H

#include <stdint.h>

/* Kernels without numbers of their own, one after another: addresses of functions and of their structs. */
typedef struct {
    int64_t count;
    const int64_t *functions;
    const int64_t *structs;
} Calls;

void calls_run(const Calls *calls);

#endif
