/* CRC-32 of the log's chunks and of its file, by products of polynomials where the processor has them. */
#include "kernels.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

/* Remainders by which 512 and 128 bits are folded onto the next, and Barrett's numbers of the last step: Gopal et al.,
   "Fast CRC computation for generic polynomials using PCLMULQDQ", Intel 2009, of the polynomial of zlib. */
static const uint64_t FOLD_512[2] = {0x154442bd4, 0x1c6e41596};
static const uint64_t FOLD_128[2] = {0x1751997d0, 0x0ccaa009e};
static const uint64_t FOLD_64[2] = {0x163cd6124, 0};
static const uint64_t BARRETT[2] = {0x1db710641, 0x1f7011641};

#define WIDE __attribute__((target("pclmul,sse4.1")))

WIDE static __m128i load(const void *place) { return _mm_loadu_si128((const __m128i *)place); }

WIDE static __m128i folded(__m128i sum, __m128i by, __m128i next) {
    const __m128i low = _mm_clmulepi64_si128(sum, by, 0x00), high = _mm_clmulepi64_si128(sum, by, 0x11);
    return _mm_xor_si128(_mm_xor_si128(low, high), next);
}

WIDE static uint32_t reduced(__m128i sum) {
    const __m128i words = _mm_setr_epi32(~0, 0, ~0, 0), last = load(BARRETT);
    sum = _mm_xor_si128(_mm_srli_si128(sum, 8), _mm_clmulepi64_si128(sum, load(FOLD_128), 0x10));
    sum = _mm_xor_si128(_mm_srli_si128(sum, 4),
                        _mm_clmulepi64_si128(_mm_and_si128(sum, words), load(FOLD_64), 0x00));
    __m128i part = _mm_clmulepi64_si128(_mm_and_si128(sum, words), last, 0x10);
    part = _mm_clmulepi64_si128(_mm_and_si128(part, words), last, 0x00);
    return (uint32_t)_mm_extract_epi32(_mm_xor_si128(sum, part), 1);
}

/* Of whole blocks of 64 bytes, at least one. */
WIDE static uint32_t crc_of(const char *data, int64_t count, uint32_t crc) {
    __m128i sums[4];
    for (int k = 0; k < 4; k++) sums[k] = load(data + 16 * k);
    sums[0] = _mm_xor_si128(sums[0], _mm_cvtsi32_si128((int)~crc));
    for (int64_t at = 64; at < count; at += 64)
        for (int k = 0; k < 4; k++) sums[k] = folded(sums[k], load(FOLD_512), load(data + at + 16 * k));
    for (int k = 1; k < 4; k++) sums[0] = folded(sums[0], load(FOLD_128), sums[k]);
    return ~reduced(sums[0]);
}

int64_t checksum(const Checksum *sum, int64_t address, int64_t count) {
    if (!__builtin_cpu_supports("pclmul") || count < 64) return 0;
    const int64_t whole = count & ~(int64_t)63;
    *sum->crc = crc_of((const char *)(intptr_t)address, whole, (uint32_t)*sum->crc);
    return whole;
}
#else
int64_t checksum(const Checksum *sum, int64_t address, int64_t count) {
    (void)sum, (void)address, (void)count;
    return 0;
}
#endif
