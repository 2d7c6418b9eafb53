cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.contact.contacts cimport ContactState
from surefoot.wbc.body.limits cimport AccelerationBounds
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference

cdef class HardConstraints:
    cdef double _damping, _levelling, _striking, _striking_damping, _softening, _sinking, _unbounded
    cdef Py_ssize_t _free
    cdef (Py_ssize_t, Py_ssize_t) _edge
    cdef AccelerationBounds _joints
    cdef object _cones, _cone_rows
    cdef const long long[:, ::1] _ankles
    cdef const long long[::1] _tipping
    cdef const double[::1] _torque_span
    cdef double[::1] _rates, _lower, _upper, _row_lower, _row_upper
    cdef double[:, ::1] _A

    cdef _stand(self, (Py_ssize_t, Py_ssize_t) edge)
    @cython.locals(edge=(Py_ssize_t, Py_ssize_t), left=cython.bint, right=cython.bint)
    cpdef write(self, RobotTerms terms, WbcReference reference, ContactState contacts)
    @cython.locals(i=Py_ssize_t, nv=Py_ssize_t)
    cdef void _motion(self, RobotTerms terms) noexcept
    @cython.locals(i=Py_ssize_t, row=Py_ssize_t, nv=Py_ssize_t, first=Py_ssize_t, sinking=double)
    cdef void _contact(self, RobotTerms terms, WbcReference reference, Py_ssize_t k, bint active, bint lands) noexcept
    cdef double _rest(self, RobotTerms terms, Py_ssize_t k, Py_ssize_t i) noexcept nogil
    @cython.locals(target=double[::1], first=Py_ssize_t, edge=int, normal=vector3, roll=vector3, behind=double, bias=double)
    cdef void _turn(self, RobotTerms terms, WbcReference reference, Py_ssize_t k) noexcept
    @cython.locals(nv=Py_ssize_t)
    cdef void _bound_joints(self, RobotTerms terms, bint left, bint right) noexcept
    @cython.locals(n=Py_ssize_t, i=Py_ssize_t, column=Py_ssize_t, turning=double)
    cdef void _rest_ankle(self, RobotTerms terms, Py_ssize_t k) noexcept nogil
    cdef void _release(self, Py_ssize_t column) noexcept nogil
