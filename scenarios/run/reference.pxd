cimport cython
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3
from surefoot.planner.geometry cimport orientation
from surefoot.planner.plan.sample cimport PlanSample
from surefoot.planner.plan.sampling cimport PlanSampler
from surefoot.wbc.reference cimport WbcReference

cdef Py_ssize_t OMEGA, STIFFNESS, LOAD, ZMP, PENDULUM_ZMP, COM, VELOCITY, ACCELERATION
cdef Py_ssize_t SWING, SWING_VELOCITY, SWING_ACCELERATION

@cython.locals(sample=PlanSample, until=PlanSample)
cpdef planned(PlanSampler sampler, double time, double middle)
@cython.locals(passed=double, left=double, reference=WbcReference)
cpdef WbcReference whole_body_reference(plan, PlanSample sample)
cdef int _roll(WbcReference reference, tuple rolls, double time) except -1
@cython.locals(swings=int, yaw_left=double, yaw_right=double)
cdef int _ground(WbcReference reference, plan, double yaw) except -1
cdef vector3 _tuple(vector)
@cython.locals(rates=vector3)
cdef void _fill(WbcReference reference, const double[::1] point) noexcept nogil
cdef vector3 _part(const double[::1] point, Py_ssize_t first) noexcept nogil
