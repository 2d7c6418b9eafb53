cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3

cdef double PI

cdef class EstimationRecorder:
    cdef object _readings, _row, _writer, _more, _extra
    cdef object _wrench, _deviations, _rotations

    cpdef tick(self, time_ns, readings, estimate, wrench, terms, truth, forces)
    cdef _tell(self, time_ns, extra)

cdef class EstimationRows:
    cdef double[:, :] _stance, _q, _base_pose, _com, _com_velocity, _true_com, _true_com_velocity
    cdef double[:, :] _soles, _true_soles
    cdef double[:, :, :] _base, _true_base
    cdef double[:, :] _com_error, _com_velocity_error, _tilt_error, _yaw_error, _sole_height_error, _place_error
    cdef double[:, ::1] _back, _turned

    @cython.locals(n=Py_ssize_t, foot=Py_ssize_t, k=Py_ssize_t)
    cpdef derive(self, Py_ssize_t rows)
    @cython.locals(R=cython.double[:, :], true=cython.double[:, :], T=cython.double[:, ::1], yaw=double, c=double, s=double)
    cdef void _turn_back(self, Py_ssize_t n) noexcept
    @cython.locals(sole=vector3, true_sole=vector3, com=vector3, true_com=vector3, velocity=vector3,
                   true_velocity=vector3)
    cdef void _err(self, Py_ssize_t n, Py_ssize_t stance) noexcept nogil

cdef double _rows_product(const double[:, :] A, Py_ssize_t i, const double[:, :] B, Py_ssize_t j) noexcept nogil
@cython.locals(off=double)
cdef double _within_half_turn(double angle) noexcept nogil
