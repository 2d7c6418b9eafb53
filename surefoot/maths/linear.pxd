from surefoot.maths.algebra cimport vector3

cpdef double dot(const double[:] a, const double[:] b) noexcept nogil
cpdef double row_dot(const double[:, :] A, Py_ssize_t i, const double[:] x) noexcept nogil
cpdef void add_scaled(double[:] y, double a, const double[:] x) noexcept nogil
cpdef void multiply(const double[:, :] A, const double[:] x, double[:] out) noexcept nogil
cpdef double quadratic(const double[:, :] A, const double[:] x) noexcept nogil
cpdef double part_dot(const double[:, :] A, Py_ssize_t i, const double[:] x, Py_ssize_t first, Py_ssize_t end) noexcept nogil
cpdef double rows_dot(const double[:, :] A, Py_ssize_t i, const double[:, :] B, Py_ssize_t j) noexcept nogil
cpdef bint factor(double[:, :] A) noexcept nogil
cpdef void forward_solve(const double[:, :] U, double[:, :] B) noexcept nogil
cpdef void forward_solve_one(const double[:, :] U, double[:] b) noexcept nogil
cpdef void backward_solve(const double[:, :] U, double[:] x) noexcept nogil
cpdef void solve_tridiagonal(double[::1] lower, double[::1] diagonal, double[::1] upper, double[:, ::1] X) noexcept nogil
cpdef void add_gram(double[:, :] S, const double[:, :] Y) noexcept nogil
cpdef void upper_product(const double[:, :] A, const double[:, :] B, double[:, :] out) noexcept nogil
cpdef void mirror(double[:, :] A) noexcept nogil
cpdef void inverse_columns(const double[:, :] U, double[:, :] out) noexcept nogil
cpdef void row_sizes(const double[:, :] A, double[:] out) noexcept nogil
cpdef void upper_solve(const double[:, :] R, Py_ssize_t count, double[:] x) noexcept nogil
cpdef void subtract_products(double[:, :] S, const double[:, :] Y) noexcept nogil
cpdef void copy_rows(double[:, :] out, Py_ssize_t i, const double[:, :] A, Py_ssize_t k, Py_ssize_t count) noexcept nogil
cpdef void scale_rows(double[:, :] out, Py_ssize_t first, double factor, const double[:] scale, const double[:, :] A, Py_ssize_t k) noexcept nogil
cpdef void add_row(double[:, :] out, Py_ssize_t i, double factor, const double[:, :] A, Py_ssize_t k) noexcept nogil
cpdef void put_transposed(double[:, :] out, Py_ssize_t i, Py_ssize_t j, double factor, const double[:, :] A) noexcept nogil
cpdef void see_columns(const double[:, :] R, const double[:] p, const double[:, :] motions, const long long[:] columns, double[:, :] out) noexcept nogil
cpdef double distance_squared(const double[:, :] A, const double[:, :] B, const double[:, :] C) noexcept nogil
cpdef void gram(const double[:, :] T, double[:, :] H) noexcept nogil
cpdef void transposed_product(const double[:, :] T, const double[:] t, double[:] g) noexcept nogil
cpdef void copy(const double[:, :] A, double[:, :] out) noexcept nogil
cpdef void product(const double[:, :] A, const double[:, :] B, double[:, :] out) noexcept nogil
cpdef void accumulate(double[:, :] S, const double[:, :] A, const double[:, :] B) noexcept nogil
cpdef void add_multiple(double[:, :] S, double a, const double[:, :] A) noexcept nogil
cpdef void add_multiples(
    double[:, :] S, double a, const double[:, :] A, double b, const double[:, :] B
) noexcept nogil
cpdef void differences(
    const double[:, :] A, const Py_ssize_t[:] one, const Py_ssize_t[:] other, double[:, :] out
) noexcept nogil
cpdef void row_products(const double[:, :] A, const double[:, :] B, double[:, :] out) noexcept nogil
cpdef void downdate(double[:, :] P, const double[:, :] Y) noexcept nogil
cpdef void inverse(const double[:, :] U, double[:, :] out) noexcept nogil
cpdef void add_products(double[:, ::1] P, const double[:, ::1] A, const double[:, ::1] B) noexcept nogil
cpdef void add_transposed_product(double scale, const double[:, :] A, const double[:] y, double[:] out) noexcept nogil
cpdef void evaluate_polynomials(const double[:, ::1] C, double t, double[::1] out) noexcept nogil
cpdef double nearest(double value) noexcept nogil
cpdef void fill(double[:] out, Py_ssize_t start, const double[:] values) noexcept nogil
cpdef void products(const double[:, :] Y, double[:, :] S) noexcept nogil
cpdef void add_product(double scale, const double[:, :] A, const double[:] x, double[:] out) noexcept nogil
cpdef void rotate_rows(double[:, :] A, Py_ssize_t i, double a, double b) noexcept nogil
cpdef bint is_zero(const double[:, :] A) noexcept nogil
cpdef double excess(const double[:] values, const double[:] lower, const double[:] upper) noexcept nogil
