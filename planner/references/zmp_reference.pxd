cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.planner.steps.phases cimport PhaseSamples

ctypedef (double, double) box2

cdef class EdgeContact:
    cdef readonly Py_ssize_t phase
    cdef readonly double start, end
    cdef readonly bint on_left
    cdef readonly double along, aside

@cython.locals(row=Py_ssize_t, one=Py_ssize_t, other=Py_ssize_t)
cdef void _place_supports(const double[:, :] position, const double[:] yaw, const Py_ssize_t[:, :] supports, Py_ssize_t stance, double[:, ::1] values) noexcept nogil
@cython.locals(row=Py_ssize_t, shift=Py_ssize_t, moved=Py_ssize_t, end=Py_ssize_t, foot=Py_ssize_t, gain=double)
cdef void _move_supports(const Py_ssize_t[:, :] supports, Py_ssize_t stance, const double[:] free, bint stay, double[:, ::1] values) noexcept nogil
@cython.locals(row=Py_ssize_t, one=Py_ssize_t, other=Py_ssize_t, first=box2, second=box2, box=box2)
cdef void _box_supports(const double[:, :] position, const double[:] yaw, const Py_ssize_t[:, :] supports, Py_ssize_t stance, const double[:] half_size, double[:, ::1] values) noexcept nogil
cdef box2 inscribed_box(double a, double b, double yaw) noexcept nogil
@cython.locals(wide=box2, long=box2, most=double)
cdef box2 joint_box(box2 box, double x, double y) noexcept nogil
@cython.locals(index=Py_ssize_t[::1], fraction=double[::1], k=Py_ssize_t, i=Py_ssize_t, axis=Py_ssize_t)
cdef void _refer(PhaseSamples samples, const double[:, :, ::1] table, double[:, ::1] point, double[:, ::1] gain, double[:, ::1] half_size, double[::1] height)
@cython.locals(index=Py_ssize_t[::1], fraction=double[::1], k=Py_ssize_t, i=Py_ssize_t, last=Py_ssize_t)
cdef void _share_load(PhaseSamples samples, const double[:] on_left, double[::1] load)
@cython.locals(which=Py_ssize_t[::1], clock=double[::1], k=Py_ssize_t, share=double)
cdef void _roll(PhaseSamples samples, EdgeContact contact, const double[:] load, const double[:, ::1] whole, double[:, ::1] half_size, double[:, ::1] middle)
@cython.locals(k=Py_ssize_t, axis=Py_ssize_t, beyond=double)
cdef void _reach(double[:, ::1] middle, double[:, ::1] half_size)

cdef class ZmpReference:
    cdef readonly object point, gain, half_size, height, middle

cdef class Support:
    cdef readonly object key, rotation, origin, table, heights, on_left, outer, inner, footholds, increment
