cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference
from surefoot.wbc.tasks cimport law
from surefoot.wbc.tasks.law cimport TaskLaw

cdef class AnkleStops:
    cdef readonly object ankles, columns, rolling, lower, upper
    cdef readonly double ahead
    cdef readonly Py_ssize_t joints
    cdef double _yielding, _turned_back
    cdef const long long[:, ::1] _columns
    cdef const double[:, ::1] _ankles
    cdef const double[:, :, ::1] _skew
    cdef const double[::1] _lower, _upper

    @cython.locals(column=Py_ssize_t, position=double, coming=double, up=double, down=double, near=double, onward=double)
    cpdef double yielding(self, RobotTerms terms, Py_ssize_t k, Py_ssize_t n, const double[:, :] desired) noexcept
    @cython.locals(row=Py_ssize_t, column=Py_ssize_t)
    cpdef vector3 axis(self, RobotTerms terms, Py_ssize_t k, Py_ssize_t n) noexcept

cdef class SwingFoot(TaskLaw):
    cdef public object weight
    cdef AnkleStops _stops
    cdef Py_ssize_t _turned
    cdef double _k, _d, _toe, _side, _lifted, _resting
    cdef double[::1] _shares
    cdef double[:, ::1] _R_d

    @cython.locals(k=Py_ssize_t)
    cdef void put(
        self, RobotTerms terms, WbcReference reference, const double[::1] scale, double[:, ::1] rows, double[::1] target
    ) noexcept
    @cython.locals(n=Py_ssize_t, most=double)
    cdef void _put_with(
        self, AnkleStops stops, RobotTerms terms, WbcReference reference, Py_ssize_t k, const double[::1] scale,
        double[:, ::1] rows, double[::1] target
    ) noexcept
    @cython.locals(
        R=double[:, ::1], v=double[::1], bias=double[::1], edge=int, roll=vector3, lift=double, along=vector3,
        pitching=double
    )
    cdef void _aim(
        self, RobotTerms terms, WbcReference reference, Py_ssize_t k, double most, double[::1] target
    ) noexcept
    cdef int _edge(self, WbcReference reference, Py_ssize_t k) noexcept nogil
    @cython.locals(e=vector3)
    cdef vector3 _along(self, WbcReference reference, vector3 position, int edge) noexcept nogil
    @cython.locals(R_d=double[:, ::1], beside=double)
    cdef double _hangs(self, double[:, ::1] R, WbcReference reference) noexcept nogil
    @cython.locals(R=double[:, ::1], R_d=double[:, ::1], k=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t)
    cdef void _see_from_ankle(
        self, AnkleStops stops, RobotTerms terms, WbcReference reference, const double[::1] scale,
        double[:, ::1] rows, double[::1] target
    ) noexcept
    @cython.locals(
        k=Py_ssize_t, column=Py_ssize_t, j=Py_ssize_t, part=double, counted=double, resting=double, turn=double
    )
    cdef void _yield(
        self, AnkleStops stops, RobotTerms terms, WbcReference reference, Py_ssize_t n,
        const double[::1] scale, double[:, ::1] rows, double[::1] target
    ) noexcept
