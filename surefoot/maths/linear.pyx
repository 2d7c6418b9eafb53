"""The functions of `linear.py` for compiled modules, which see there what they do.

Sums go in an order of their own, the same on every machine.
"""

from libc.math cimport rint, sqrt
from surefoot.maths.algebra cimport vector3
from libc.string cimport memcpy, memset


cdef inline double _dot(const double *a, const double *b, Py_ssize_t count) noexcept nogil:
    """Four sums beside each other: one alone would wait for itself at each term."""
    cdef double first = 0.0, second = 0.0, third = 0.0, fourth = 0.0
    cdef Py_ssize_t i = 0
    while i + 4 <= count:
        first += a[i] * b[i]
        second += a[i + 1] * b[i + 1]
        third += a[i + 2] * b[i + 2]
        fourth += a[i + 3] * b[i + 3]
        i += 4
    if i < count:
        first += a[i] * b[i]
    if i + 1 < count:
        second += a[i + 1] * b[i + 1]
    if i + 2 < count:
        third += a[i + 2] * b[i + 2]
    return (first + second) + (third + fourth)


cdef void _subtract_rows(
    double *out, Py_ssize_t count, const double *factors, Py_ssize_t factor_stride,
    const double *rows, Py_ssize_t row_stride, Py_ssize_t terms
) noexcept nogil:
    """out -= sum of factor times row; four at a time, since to load and store `out` costs more than the products."""
    cdef Py_ssize_t k = 0, j
    cdef const double *f
    cdef const double *first
    cdef const double *second
    cdef const double *third
    cdef const double *fourth
    cdef double a, b, c, d
    while k + 4 <= terms:
        f = factors + factor_stride * k
        first = rows + row_stride * k
        second = first + row_stride
        third = second + row_stride
        fourth = third + row_stride
        a, b, c, d = f[0], f[factor_stride], f[2 * factor_stride], f[3 * factor_stride]
        k += 4
        if a == 0.0 and b == 0.0 and c == 0.0 and d == 0.0:
            continue
        for j in range(count):
            out[j] -= (a * first[j] + b * second[j]) + (c * third[j] + d * fourth[j])
    while k < terms:
        a = factors[factor_stride * k]
        first = rows + row_stride * k
        for j in range(count):
            out[j] -= a * first[j]
        k += 1


cdef inline Py_ssize_t _stride(const double[:, :] A) noexcept nogil:
    return A.strides[0] // <Py_ssize_t>sizeof(double)


cpdef double dot(const double[:] a, const double[:] b) noexcept nogil:
    return _dot(&a[0], &b[0], a.shape[0]) if a.shape[0] else 0.0


cpdef double row_dot(const double[:, :] A, Py_ssize_t i, const double[:] x) noexcept nogil:
    return _dot(&A[i, 0], &x[0], A.shape[1])


cpdef void add_scaled(double[:] y, double a, const double[:] x) noexcept nogil:
    cdef double *out = &y[0]
    cdef const double *added = &x[0]
    cdef Py_ssize_t i
    for i in range(y.shape[0]):
        out[i] += a * added[i]


cpdef void multiply(const double[:, :] A, const double[:] x, double[:] out) noexcept nogil:
    cdef Py_ssize_t i
    for i in range(A.shape[0]):
        out[i] = _dot(&A[i, 0], &x[0], A.shape[1])


cpdef double quadratic(const double[:, :] A, const double[:] x) noexcept nogil:
    cdef Py_ssize_t i, n = A.shape[1]
    cdef double found = 0.0
    for i in range(A.shape[0]):
        if x[i] != 0.0:
            found += x[i] * _dot(&A[i, 0], &x[0], n)
    return found


cpdef double part_dot(const double[:, :] A, Py_ssize_t i, const double[:] x, Py_ssize_t first, Py_ssize_t end) noexcept nogil:
    return _dot(&A[i, first], &x[first], end - first)


cpdef double rows_dot(const double[:, :] A, Py_ssize_t i, const double[:, :] B, Py_ssize_t j) noexcept nogil:
    return _dot(&A[i, 0], &B[j, 0], A.shape[1])


cpdef bint factor(double[:, :] A) noexcept nogil:
    cdef Py_ssize_t size = A.shape[0], stride = _stride(A), i, j
    cdef double *start = &A[0, 0]
    cdef double *row
    for i in range(size):
        row = start + stride * i + i
        _subtract_rows(row, size - i, start + i, stride, start + i, stride, i)
        if not row[0] > 0.0:
            return True
        row[0] = 1.0 / sqrt(row[0])
        for j in range(1, size - i):
            row[j] *= row[0]
    return False


cdef void _forward(
    const double *U, Py_ssize_t size, Py_ssize_t stride, double *B, Py_ssize_t width, Py_ssize_t apart
) noexcept nogil:
    cdef Py_ssize_t i, c
    cdef double *y
    for i in range(size):
        y = B + apart * i
        _subtract_rows(y, width, U + i, stride, B, apart, i)
        for c in range(width):
            y[c] *= U[stride * i + i]


cpdef void forward_solve(const double[:, :] U, double[:, :] B) noexcept nogil:
    _forward(&U[0, 0], U.shape[0], _stride(U), &B[0, 0], B.shape[1], _stride(B))


cpdef void forward_solve_one(const double[:, :] U, double[:] b) noexcept nogil:
    _forward(&U[0, 0], U.shape[0], _stride(U), &b[0], 1, 1)


cdef void _backward(const double *U, Py_ssize_t size, Py_ssize_t stride, double *x) noexcept nogil:
    cdef Py_ssize_t i
    cdef const double *row
    for i in range(size - 1, -1, -1):
        row = U + stride * i
        x[i] = (x[i] - _dot(row + i + 1, x + i + 1, size - i - 1)) * row[i]


cpdef void backward_solve(const double[:, :] U, double[:] x) noexcept nogil:
    _backward(&U[0, 0], U.shape[0], _stride(U), &x[0])


cpdef void inverse_columns(const double[:, :] U, double[:, :] out) noexcept nogil:
    cdef Py_ssize_t k
    out[:, :] = 0.0
    for k in range(U.shape[0]):
        out[k, k] = 1.0
        _backward(&U[0, 0], U.shape[0], _stride(U), &out[k, 0])


cpdef void row_sizes(const double[:, :] A, double[:] out) noexcept nogil:
    cdef Py_ssize_t i
    for i in range(A.shape[0]):
        out[i] = sqrt(_dot(&A[i, 0], &A[i, 0], A.shape[1]))


cpdef void upper_solve(const double[:, :] R, Py_ssize_t count, double[:] x) noexcept nogil:
    cdef Py_ssize_t i
    for i in range(count - 1, -1, -1):
        x[i] = (x[i] - _dot(&R[i, 0] + i + 1, &x[0] + i + 1, count - 1 - i)) / R[i, i]


cpdef void solve_tridiagonal(double[::1] lower, double[::1] diagonal, double[::1] upper, double[:, ::1] X) noexcept nogil:
    cdef Py_ssize_t n = X.shape[0], width = X.shape[1], i, c
    cdef double pivot
    for i in range(n):
        pivot = 1.0 / (diagonal[i] - lower[i] * upper[i - 1] if i else diagonal[i])
        upper[i] *= pivot
        for c in range(width):
            X[i, c] = (X[i, c] - lower[i] * X[i - 1, c] if i else X[i, c]) * pivot
    for i in range(n - 2, -1, -1):
        for c in range(width):
            X[i, c] -= upper[i] * X[i + 1, c]


cpdef void add_gram(double[:, :] S, const double[:, :] Y) noexcept nogil:
    cdef Py_ssize_t e, r, j, width = S.shape[1]
    cdef double *out
    cdef const double *row
    cdef double factor
    for r in range(Y.shape[0]):
        row = &Y[r, 0]
        for e in range(S.shape[0]):
            out = &S[e, 0]
            factor = row[e]
            for j in range(e, width):
                out[j] += factor * row[j]


cpdef void upper_product(const double[:, :] A, const double[:, :] B, double[:, :] out) noexcept nogil:
    cdef Py_ssize_t i, j
    for i in range(A.shape[0]):
        for j in range(i, A.shape[0]):
            out[i, j] = _dot(&A[i, 0], &B[j, 0], A.shape[1])


cpdef void mirror(double[:, :] A) noexcept nogil:
    cdef Py_ssize_t i, j
    for i in range(A.shape[0]):
        for j in range(i):
            A[i, j] = A[j, i]


cpdef void subtract_products(double[:, :] S, const double[:, :] Y) noexcept nogil:
    cdef Py_ssize_t e, width = S.shape[1]
    for e in range(S.shape[0]):
        _subtract_rows(&S[e, e], width - e, &Y[0, e], _stride(Y), &Y[0, e], _stride(Y), Y.shape[0])


cpdef void copy_rows(double[:, :] out, Py_ssize_t i, const double[:, :] A, Py_ssize_t k, Py_ssize_t count) noexcept nogil:
    cdef Py_ssize_t row
    for row in range(count):
        memcpy(&out[i + row, 0], &A[k + row, 0], A.shape[1] * sizeof(double))


cpdef void scale_rows(
    double[:, :] out, Py_ssize_t first, double factor, const double[:] scale, const double[:, :] A, Py_ssize_t k
) noexcept nogil:
    cdef Py_ssize_t i, j
    cdef double *row
    cdef const double *other
    cdef double times
    for i in range(scale.shape[0]):
        row, other, times = &out[i, first], &A[k + i, 0], scale[i] * factor
        for j in range(A.shape[1]):
            row[j] = times * other[j]


cpdef void add_row(
    double[:, :] out, Py_ssize_t i, double factor, const double[:, :] A, Py_ssize_t k
) noexcept nogil:
    cdef double *row = &out[i, 0]
    cdef const double *other = &A[k, 0]
    cdef Py_ssize_t j
    for j in range(A.shape[1]):
        row[j] += factor * other[j]


cpdef void put_transposed(
    double[:, :] out, Py_ssize_t i, Py_ssize_t j, double factor, const double[:, :] A
) noexcept nogil:
    cdef Py_ssize_t k, l
    cdef double *row
    for l in range(A.shape[1]):
        row = &out[i + l, j]
        for k in range(A.shape[0]):
            row[k] = factor * A[k, l]


cpdef void see_columns(
    const double[:, :] R, const double[:] p, const double[:, :] motions, const long long[:] columns, double[:, :] out
) noexcept nogil:
    cdef Py_ssize_t n, i, j
    cdef double[3] v
    cdef double[3] w
    for n in range(columns.shape[0]):
        j = columns[n]
        for i in range(3):
            w[i] = motions[3 + i, j]
        v[0] = motions[0, j] - (p[1] * w[2] - p[2] * w[1])
        v[1] = motions[1, j] - (p[2] * w[0] - p[0] * w[2])
        v[2] = motions[2, j] - (p[0] * w[1] - p[1] * w[0])
        for i in range(3):
            out[i, j] = R[0, i] * v[0] + R[1, i] * v[1] + R[2, i] * v[2]
            out[3 + i, j] = R[0, i] * w[0] + R[1, i] * w[1] + R[2, i] * w[2]


cpdef double distance_squared(const double[:, :] A, const double[:, :] B, const double[:, :] C) noexcept nogil:
    cdef Py_ssize_t i, j
    cdef double total = 0.0, change
    for i in range(3):
        for j in range(3):
            change = A[0, i] * B[0, j] + A[1, i] * B[1, j] + A[2, i] * B[2, j] - C[i, j]
            total += change * change
    return total


cdef (Py_ssize_t, Py_ssize_t) _span(const double *row, Py_ssize_t count) noexcept nogil:
    """First entry that is not zero, and the end of those: most rows are those of a motion or of the wrenches alone."""
    cdef Py_ssize_t first = 0, end = count
    while first < count and row[first] == 0.0:
        first += 1
    while end > first and row[end - 1] == 0.0:
        end -= 1
    return first, end


cpdef void gram(const double[:, :] T, double[:, :] H) noexcept nogil:
    cdef Py_ssize_t n = T.shape[1], k, i, j, first, end
    cdef const double *row
    cdef double *out
    cdef double factor
    for i in range(n):
        memset(&H[i, 0], 0, n * sizeof(double))
    for k in range(T.shape[0]):
        row = &T[k, 0]
        first, end = _span(row, n)
        for i in range(first, end):
            factor = row[i]
            if factor == 0.0:
                continue
            out = &H[i, 0]
            for j in range(i, end):
                out[j] += factor * row[j]
    for i in range(n):
        out = &H[i, 0]
        for j in range(i):
            out[j] = H[j, i]


cpdef void transposed_product(const double[:, :] T, const double[:] t, double[:] g) noexcept nogil:
    cdef Py_ssize_t n = T.shape[1], k, j, first, end
    cdef const double *row
    cdef double *out = &g[0]
    cdef double factor
    for j in range(n):
        out[j] = 0.0
    for k in range(T.shape[0]):
        row = &T[k, 0]
        first, end = _span(row, n)
        factor = t[k]
        for j in range(first, end):
            out[j] += factor * row[j]


cdef inline void _add_row(
    double *out, Py_ssize_t step, double factor, const double *row, Py_ssize_t row_step, Py_ssize_t count
) noexcept nogil:
    """out += factor row, of numbers that are steps apart."""
    cdef Py_ssize_t c
    if step == 1 and row_step == 1:
        for c in range(count):
            out[c] += factor * row[c]
    else:
        for c in range(count):
            out[step * c] += factor * row[row_step * c]


cdef inline Py_ssize_t _step(const double[:, :] A) noexcept nogil:
    return A.strides[1] // <Py_ssize_t>sizeof(double)


cpdef void copy(const double[:, :] A, double[:, :] out) noexcept nogil:
    cdef Py_ssize_t i, c
    for i in range(A.shape[0]):
        for c in range(A.shape[1]):
            out[i, c] = A[i, c]


cpdef void product(const double[:, :] A, const double[:, :] B, double[:, :] out) noexcept nogil:
    cdef Py_ssize_t i, c, step = _step(out)
    cdef double *row
    for i in range(out.shape[0]):
        row = &out[i, 0]
        for c in range(out.shape[1]):
            row[step * c] = 0.0
    accumulate(out, A, B)


cpdef void accumulate(double[:, :] S, const double[:, :] A, const double[:, :] B) noexcept nogil:
    cdef Py_ssize_t i, j, step = _step(S), row_step = _step(B), count = S.shape[1]
    for i in range(S.shape[0]):
        for j in range(B.shape[0]):
            _add_row(&S[i, 0], step, A[i, j], &B[j, 0], row_step, count)


cpdef void add_multiple(double[:, :] S, double a, const double[:, :] A) noexcept nogil:
    cdef Py_ssize_t i
    for i in range(S.shape[0]):
        _add_row(&S[i, 0], _step(S), a, &A[i, 0], _step(A), S.shape[1])


cpdef void add_multiples(
    double[:, :] S, double a, const double[:, :] A, double b, const double[:, :] B
) noexcept nogil:
    cdef Py_ssize_t i, c
    for i in range(S.shape[0]):
        for c in range(S.shape[1]):
            S[i, c] += a * A[i, c] + b * B[i, c]


cpdef void differences(
    const double[:, :] A, const Py_ssize_t[:] one, const Py_ssize_t[:] other, double[:, :] out
) noexcept nogil:
    cdef Py_ssize_t i, c
    for i in range(A.shape[0]):
        for c in range(one.shape[0]):
            out[i, c] = A[i, one[c]] - A[i, other[c]]


cpdef void row_products(const double[:, :] A, const double[:, :] B, double[:, :] out) noexcept nogil:
    cdef Py_ssize_t i, j
    for i in range(A.shape[0]):
        for j in range(B.shape[0]):
            out[i, j] = _dot(&A[i, 0], &B[j, 0], A.shape[1])


cpdef void downdate(double[:, :] P, const double[:, :] Y) noexcept nogil:
    cdef Py_ssize_t n = P.shape[0], i, j, r
    cdef double *row
    for i in range(n):
        row = &P[i, 0]
        for j in range(i + 1, n):
            row[j] = 0.5 * (row[j] + P[j, i])
        for r in range(Y.shape[0]):
            _add_row(row + i, 1, -Y[r, i], &Y[r, i], 1, n - i)
    for i in range(n):
        for j in range(i + 1, n):
            P[j, i] = P[i, j]


cpdef void inverse(const double[:, :] U, double[:, :] out) noexcept nogil:
    cdef Py_ssize_t n = U.shape[0], r, s, a
    cdef double total
    for r in range(n):
        for s in range(n):
            out[r, s] = 1.0 if r == s else 0.0
    forward_solve(U, out)
    # Row r of the product reads columns from r on alone: it may be written over what is left of them.
    for r in range(n):
        for s in range(r, n):
            total = 0.0
            for a in range(s, n):
                total += out[a, r] * out[a, s]
            out[r, s] = total
    for r in range(n):
        for s in range(r + 1, n):
            out[s, r] = out[r, s]


cpdef void add_products(double[:, ::1] P, const double[:, ::1] A, const double[:, ::1] B) noexcept nogil:
    cdef Py_ssize_t k, i, j, n = A.shape[1]
    cdef double a
    for k in range(A.shape[0]):
        for i in range(n):
            a = A[k, i]
            for j in range(i, n):
                P[i, j] += a * B[k, j]


cpdef void add_transposed_product(double scale, const double[:, :] A, const double[:] y, double[:] out) noexcept nogil:
    cdef Py_ssize_t i, j
    cdef double factor
    cdef double *sums = &out[0]
    cdef const double *row
    for i in range(A.shape[0]):
        factor, row = scale * y[i], &A[i, 0]
        for j in range(A.shape[1]):
            sums[j] += factor * row[j]


cpdef void evaluate_polynomials(const double[:, ::1] C, double t, double[::1] out) noexcept nogil:
    cdef Py_ssize_t k, i, last = C.shape[0] - 1
    for i in range(C.shape[1]):
        out[i] = C[last, i]
    for k in range(last - 1, -1, -1):
        for i in range(C.shape[1]):
            out[i] = out[i] * t + C[k, i]


cpdef void products(const double[:, :] Y, double[:, :] S) noexcept nogil:
    cdef Py_ssize_t e, c, width = S.shape[1]
    cdef double *row
    for e in range(S.shape[0]):
        row = &S[e, 0]
        for c in range(width):
            row[c] = 0.0
        _subtract_rows(row + e, width - e, &Y[0, e], _stride(Y), &Y[0, e], _stride(Y), Y.shape[0])
        for c in range(e, width):
            row[c] = -row[c]


cpdef void add_product(double scale, const double[:, :] A, const double[:] x, double[:] out) noexcept nogil:
    cdef Py_ssize_t i
    for i in range(A.shape[0]):
        out[i] += scale * _dot(&A[i, 0], &x[0], A.shape[1])


cpdef void rotate_rows(double[:, :] A, Py_ssize_t i, double a, double b) noexcept nogil:
    cdef double size = sqrt(a * a + b * b), one, other
    cdef double c = a / size, s = b / size
    cdef double *x = &A[i, 0]
    cdef double *y = &A[i + 1, 0]
    cdef Py_ssize_t j
    for j in range(A.shape[1]):
        one, other = x[j], y[j]
        x[j] = c * one + s * other
        y[j] = c * other - s * one


cpdef bint is_zero(const double[:, :] A) noexcept nogil:
    cdef Py_ssize_t i, j
    for i in range(A.shape[0]):
        for j in range(A.shape[1]):
            if A[i, j] != 0.0:
                return False
    return True


cpdef double excess(const double[:] values, const double[:] lower, const double[:] upper) noexcept nogil:
    cdef double worst = 0.0, below, above
    cdef Py_ssize_t i
    for i in range(values.shape[0]):
        below, above = lower[i] - values[i], values[i] - upper[i]
        if not below <= worst:
            worst = below
        if not above <= worst:
            worst = above
        if worst != worst:
            return worst
    return worst


cpdef double nearest(double value) noexcept nogil:
    return rint(value)


cpdef void fill(double[:] out, Py_ssize_t start, const double[:] values) noexcept nogil:
    cdef Py_ssize_t i
    for i in range(values.shape[0]):
        out[start + i] = values[i]
