cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.readings cimport Reading, Readings
from surefoot.sim.imu_motion cimport ImuChain, ImuMotion

cdef class Buffer:
    cdef object _array
    cdef double[::1] values

    cdef take(self, truth, str name)
    cdef copied(self)

cdef class Noise:
    cdef object _deviation, _rng, _block
    cdef Py_ssize_t _next
    cdef bint _silent
    cdef double[:, ::1] _drawn

    @cython.locals(i=Py_ssize_t)
    cdef add(self, double[::1] values)

cdef class Drift:
    cdef double[::1] _value
    cdef Noise _steps
    cdef bint _at_start

    @cython.locals(i=Py_ssize_t)
    cdef add(self, double[::1] values)

cdef class Encoders:
    cdef bint say_velocity
    cdef Buffer _position, _torque, _velocity
    cdef double[::1] _offset
    cdef Noise _noise, _velocity_noise, _torque_noise
    cdef double _step

    cdef list sample(self, truth)
    @cython.locals(i=Py_ssize_t)
    cdef _encode(self, double[::1] position)

cdef class Imu:
    cdef ImuChain _chain
    cdef ImuMotion _before
    cdef Buffer _q, _v, _rate, _mean_rate, _force
    cdef double _period, _most_rate, _most_force
    cdef vector3 _gravity
    cdef Noise _gyro_noise, _force_noise
    cdef Drift _gyro_bias, _force_bias
    cdef double[::1] _error
    cdef double[:, ::1] _sum

    cdef list sample(self, truth)
    @cython.locals(mean_rate=vector3, force=vector3, error=vector3, said=cython.double[::1])
    cdef _sense(self, ImuMotion now)
    @cython.locals(before=ImuMotion, moved=vector3, force=vector3, gravity=vector3, T=double, i=Py_ssize_t, j=Py_ssize_t)
    cdef (vector3, vector3) _over_period(self, ImuMotion now)

cdef class Feet:
    cdef Buffer _wrench
    cdef Noise _noise
    cdef Drift _bias

    cdef list sample(self, truth)

cdef class Line:
    cdef object _delivery, _late, _lost
    cdef double _period
    cdef bint _direct
    cdef list _under_way, _values
    cdef Py_ssize_t _taken

    @cython.locals(arrival=double, sent=Py_ssize_t, taken=Py_ssize_t, before=Py_ssize_t, now=double, newest=double,
                   age=double, fresh=cython.bint)
    cdef list through(self, Py_ssize_t tick, list sample)
    cdef _send(self, Py_ssize_t tick, list sample)

cdef class SensorSuite:
    cdef object _rate
    cdef Imu _imu
    cdef Encoders _encoders
    cdef Feet _feet
    cdef list _lines

    @cython.locals(line=Line)
    cpdef Readings read(self, measurement, Py_ssize_t tick)

cdef vector3 _within(double most, vector3 values) noexcept nogil
