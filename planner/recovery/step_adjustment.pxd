cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.planner.model cimport pendulum
from surefoot.planner.recovery.outlook cimport Outlook
from surefoot.planner.recovery.reach cimport StepReach

cdef double NO_GAIN
cdef Py_ssize_t NOW, LIFT_OFF, LANDED

cdef class StepAdjustment:
    cdef StepReach _reach
    cdef Outlook _outlook
    cdef bint _timing
    cdef double _sample_time, _longest_cut, _shift_weight, _second_weight, _time_weight, _stretch_weight
    cdef double _swing_weight, _cross_factor, _least_saving, _cop_share, _landing_share, _landing_spare
    cdef double _tolerance, _unheld_share, _stand_share, _least_double, _least_single
    cdef double _omega, _gain, _double_growth, _single_growth, _cycle_growth
    cdef const double[:] _com, _dcm
    cdef const double[::1] _authority, _changes
    cdef double[::1] _doubles, _singles, _held, _more, _wanted, _low, _high, _hips, _place, _second

    cpdef solve(self, const double[:] com, const double[:] dcm, window, step, double uncertainty=*)
    @cython.locals(step=StepReach)
    cdef void _grow(self) noexcept
    @cython.locals(
        ahead=Outlook, step=StepReach, lift=Py_ssize_t, lands=Py_ssize_t, axis=Py_ssize_t, held=cython.bint,
        box=double, own=double
    )
    cdef bint _is_held(self, double uncertainty) noexcept
    @cython.locals(
        step=StepReach, box=Py_ssize_t, d=Py_ssize_t, s=Py_ssize_t, doubles=Py_ssize_t, singles=Py_ssize_t,
        best=Py_ssize_t, planned=double, cost=double, least=double, double=double, single=double
    )
    cdef (double, double, Py_ssize_t) _cheapest(self, bint fine) noexcept
    @cython.locals(step=StepReach, most=double, least=double, singles=Py_ssize_t)
    cdef (Py_ssize_t, Py_ssize_t) _time_choices(self, bint fine) noexcept
    @cython.locals(k=Py_ssize_t, count=Py_ssize_t)
    cdef Py_ssize_t _around(self, double[::1] times, double time, double least, double most) noexcept
    @cython.locals(
        step=StepReach, ahead=Outlook, axis=Py_ssize_t, way=double, share=double, second=double, stretch=double
    )
    cdef double _cost(self, Py_ssize_t box, double double, double single) noexcept
    @cython.locals(step=StepReach)
    cdef double _way(self, Py_ssize_t axis, Py_ssize_t box) noexcept
    @cython.locals(step=StepReach, lifted=double, start=double, there=double)
    cdef double _land(self, Py_ssize_t axis, double double, double spread, double grown) noexcept
    @cython.locals(
        step=StepReach, axis=Py_ssize_t, low=double, high=double, unheld=double, least=double, greatest=double,
        most=double, values=double[:, ::1]
    )
    cdef _landing_box(self, Py_ssize_t box)
