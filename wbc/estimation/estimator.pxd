cimport cython
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3
from surefoot.readings cimport Reading, Readings
from surefoot.wbc.estimation.base cimport FloatingBase
from surefoot.wbc.estimation.contact cimport SoleContact
from surefoot.wbc.estimation.doubt cimport Doubt
from surefoot.wbc.estimation.estimate cimport Deviation, Estimate
from surefoot.wbc.estimation.invariant_filter cimport InvariantFilter
from surefoot.wbc.estimation.joints cimport JointObserver
from surefoot.wbc.estimation.kinematics cimport SensedBody
from surefoot.wbc.estimation.rates cimport RateFilter
from surefoot.wbc.estimation.stand cimport Stand

cdef class SensedState:
    cdef readonly object parameters
    cdef object _footing, _model, _sole_names, _torques, _encoders, _load, _state, _deviation
    cdef double _period, _weight, _from
    cdef Py_ssize_t _count, _every, _tick, _imu_at, _torques_at, _accelerated
    cdef bint _begun, _lost
    cdef list _still
    cdef tuple _shapes
    cdef (int, int) _edge
    cdef SensedBody _body
    cdef JointObserver _joints
    cdef RateFilter _rate
    cdef SoleContact _contact
    cdef InvariantFilter _filter
    cdef Stand _stand
    cdef Doubt _doubt
    cdef FloatingBase _base
    cdef double[:, ::1] _accelerations
    cdef double[::1] _gained, _turned, _unmoved, _above

    @cython.locals(slot=Py_ssize_t, i=Py_ssize_t)
    cdef void _remember(self, const double[:] acceleration)
    @cython.locals(reading=Reading)
    cdef Readings _fitting(self, Readings readings)
    @cython.locals(contact=SoleContact)
    cpdef Estimate sense(self, Readings readings)
    @cython.locals(at=Py_ssize_t, time=double, v=vector3)
    cdef _measured(self, Readings readings)
    @cython.locals(filter_=InvariantFilter, contact=SoleContact, body=SensedBody, changed=cython.bint, rolled=cython.bint, due=cython.bint)
    cdef _step(self, Readings readings)
    @cython.locals(ahead=double[::1], half_length=double, rolled=cython.bint, k=Py_ssize_t, place=double)
    cdef bint _roll(self)
    @cython.locals(at=Py_ssize_t, gained=double[::1])
    cdef _turn(self, Readings readings)
    @cython.locals(back=Py_ssize_t)
    cdef bint _hears(self, Py_ssize_t at)
    @cython.locals(step=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, back=Py_ssize_t, gained=double)
    cdef void _add_accelerations(self, Py_ssize_t first, Py_ssize_t last) noexcept
    @cython.locals(filter_=InvariantFilter, body=SensedBody)
    cdef _renew(self, bint changed)
    cdef double _share(self, Py_ssize_t k) noexcept
    @cython.locals(reach=vector3, state=Stand)
    cdef vector3 _sole(self, Py_ssize_t k) noexcept
    @cython.locals(k=Py_ssize_t, x=double, y=double, z=double)
    cdef _look_down(self)
    @cython.locals(late=Py_ssize_t, gained=double[::1])
    cdef _now(self)

cdef bint _fits(Reading reading, tuple shape)
