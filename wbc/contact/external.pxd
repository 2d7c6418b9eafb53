cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.wbc.body.model cimport RobotTerms

cdef Py_ssize_t SPANS, LATEST, _PULLS
cdef double LEAST_PRESS, MOST

cdef class LoadObserver:
    cdef double _mass, _weight, _span, _age
    cdef Py_ssize_t _ticks, _count, _newest, _filled
    cdef bint _begun, _waits
    cdef double[::1] _felt, _com, _momentum, _most_change, _bound, _push, _share, _lasting_wide, _acting_wide
    cdef double[::1] _estimate, _wanted, _sorted, _now, _change, _deviation, _found, _wrench
    cdef double[:, ::1] _past, _spans, _kept, _sudden
    cdef readonly object found, load
    cdef object _given

    cpdef update(self, RobotTerms terms, wrench, (double, double) deviation=*, double age=*)
    @cython.locals(i=Py_ssize_t, past=double[::1], turning=algebra.vector3)
    cdef void _note(self, RobotTerms terms)
    @cython.locals(k=Py_ssize_t)
    cdef void _begin(self)
    @cython.locals(i=Py_ssize_t, j=Py_ssize_t, felt=double)
    cdef void _feel(self, RobotTerms terms)
    @cython.locals(is_found=cython.bint, is_known=cython.bint, i=Py_ssize_t)
    cdef void _end(self, double deviation, double turning)
    @cython.locals(late=double)
    cdef double _late(self) noexcept
    @cython.locals(i=Py_ssize_t, is_pressed=cython.bint, turning=algebra.vector3)
    cdef bint _balance(self, double late)
    @cython.locals(i=Py_ssize_t, whole=Py_ssize_t, count=Py_ssize_t)
    cdef void _see(self, double late)
    @cython.locals(k=Py_ssize_t)
    cdef void _keep(self)
    @cython.locals(
        i=Py_ssize_t, calm=double, lasting=double, latest=double, deviation=double, least=double, kept=double,
        sudden=double, share=double, most=double,
    )
    cdef void _follow(self, double uncertainty)
    @cython.locals(k=Py_ssize_t, hardest=double)
    cdef double _calm(self) noexcept
    @cython.locals(k=Py_ssize_t, place=Py_ssize_t, value=double, middle=double)
    cdef double _median(self, Py_ssize_t number, Py_ssize_t count) noexcept
    cdef _tell(self)

cdef double _ramp(double value, const double[:] limits, double deviation, const double[:] times) noexcept
