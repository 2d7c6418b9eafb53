cimport cython
from libc.stdint cimport int64_t
from surefoot cimport algebra
from surefoot.algebra cimport vector3
from surefoot.planner cimport orientation
from surefoot.planner.sampling cimport PlanSampler

cdef const int64_t[::1] INTO, OUT_OF
cdef Py_ssize_t ZMP, PENDULUM_ZMP, LOAD, SWING, RATE, BEND
cdef Py_ssize_t OFFSET, SPIN, SPIN_RATE, ROTATION, NORMAL, HEADING, SHARE, ROLL, SIZE

cpdef planned(PlanSampler sampler, double time, double middle)
@cython.locals(told=double[::1], passed=double, left=double, right=double, swings=Py_ssize_t, progress=double,
               lifting=Py_ssize_t, rolling=Py_ssize_t, yaw=double, switch=double)
cpdef whole_body_reference(plan, sample)
@cython.locals(axis=Py_ssize_t)
cdef void _stand(double[::1] numbers, Py_ssize_t foot, const double[:] normal) noexcept nogil
@cython.locals(k=Py_ssize_t, axis=Py_ssize_t, rates=vector3)
cdef void _fill(double[::1] numbers, double[:, ::1] R, const double[::1] point) noexcept nogil
