cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.engines.mimic cimport Dynamics, JointColumns
from surefoot.wbc.estimation.kinematics cimport Sole

cdef double LEVER, BASE_NOISE

cdef class TorqueWrench:
    cdef readonly object wrench, residual
    cdef readonly tuple deviation
    cdef readonly double late
    cdef object _model, _data, _spreads
    cdef JointColumns _columns
    cdef Dynamics _dynamics
    cdef double _period, _gain, _torque_noise
    cdef bint _held, _begun
    cdef Sole _left, _right
    cdef double[:, :] _upper
    cdef const double[:, ::1] _M, _C, _J
    cdef const double[::1] _gravity
    cdef double[:, ::1] _supporting, _some, _noisy, _noise, _A, _both, _root
    cdef double[:, :] _normal
    cdef const Py_ssize_t[::1] _rows
    cdef double[::1] _velocity_noise, _residual, _momentum, _driven, _torque, _M_v, _C_v, _spread

    @cython.locals(span=double)
    cpdef update(self, state, torque, passed=*)
    @cython.locals(share=double, i=Py_ssize_t, momentum=double, driven=double, now=double, acted=double, lacking=double)
    cdef void _observe(self, const double[:] v, const double[:] torque, double span)
    @cython.locals(r=Py_ssize_t, j=Py_ssize_t, row=Py_ssize_t, a=Py_ssize_t)
    cdef bint _weigh(self)
    @cython.locals(r=Py_ssize_t, row=Py_ssize_t, along=vector3, angular=vector3, at_sole=vector3, force=vector3, moment=vector3, carries=double)
    cdef void _see(self, Py_ssize_t k, Sole sole) noexcept
    @cython.locals(a=Py_ssize_t, r=Py_ssize_t, variance=double, found=double, scale=double)
    cdef void _explain(self, double[::1] wrench)
