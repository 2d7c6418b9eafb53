cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.planner.geometry cimport quintic
from surefoot.planner.swing cimport rolling
from surefoot.planner.geometry.quintic cimport quintic6

@cython.final
cdef class UnitSwing:
    cdef readonly object of
    cdef readonly double climb
    cdef double _start, _gliding, _falls, _touches, _rise_start, _fall_start, _end, _low
    cdef quintic6 _glide, _rise, _fall

    cdef double progress(self, double t) noexcept nogil
    cdef double height(self, double t) noexcept nogil

@cython.final
cdef class NominalFeet:
    cdef readonly object soles, heading, pitch
    cdef double[:, :, ::1] _soles
    cdef double[:, ::1] _heading, _pitch, _places
    cdef const Py_ssize_t[::1] _which
    cdef const double[::1] _elapsed, _clock
    cdef double _heading_of_frame, _sunk, _sample_time

    @cython.locals(first=Py_ssize_t, end=Py_ssize_t, row=Py_ssize_t, swings=Py_ssize_t, begin=Py_ssize_t, swing=UnitSwing)
    cpdef move(self, Py_ssize_t count, samples, schedule, frame, flown=*)
    @cython.locals(end=Py_ssize_t)
    cdef Py_ssize_t _end_of_phase(self, Py_ssize_t first, Py_ssize_t count) noexcept nogil
    @cython.locals(k=Py_ssize_t)
    cdef void _rest(self, Py_ssize_t first, Py_ssize_t end, Py_ssize_t row, Py_ssize_t swings) noexcept nogil
    @cython.locals(k=Py_ssize_t, before=Py_ssize_t, after=Py_ssize_t, over=double)
    cdef void _swing(self, UnitSwing swing, double late, Py_ssize_t first, Py_ssize_t end, Py_ssize_t row, Py_ssize_t swings) noexcept nogil
    @cython.locals(axis=Py_ssize_t, before=Py_ssize_t, after=Py_ssize_t, stands=Py_ssize_t, P=double[:, ::1], soles=double[:, :, ::1], heading=double[:, ::1])
    cdef void _put(self, Py_ssize_t k, Py_ssize_t row, Py_ssize_t swings, double progress, double height) noexcept nogil
    @cython.locals(last=Py_ssize_t)
    cdef (Py_ssize_t, Py_ssize_t) _around(self, Py_ssize_t row) noexcept nogil
    @cython.locals(k=Py_ssize_t)
    cdef void _roll(self, double start, double over, double angle, Py_ssize_t first, Py_ssize_t end, Py_ssize_t foot) noexcept nogil
