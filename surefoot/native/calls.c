/* Several kernels in one call. */
#include "kernels.h"

typedef void (*Kernel)(const void *);

/* All kernels take the address of one struct. */
void calls_run(const Calls *calls) {
    for (int64_t k = 0; k < calls->count; k++)
        ((Kernel)(intptr_t)calls->functions[k])((const void *)(intptr_t)calls->structs[k]);
}
