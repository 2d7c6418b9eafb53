cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.engines.mimic cimport Dynamics, JointColumns
from surefoot.wbc.body.frame cimport Frame

cdef class RobotTerms:
    cdef readonly object model, data, leaning, load
    cdef readonly double mass, model_mass, wrench_unit
    cdef readonly Py_ssize_t nv
    cdef readonly bint waist, is_finite, is_shifted
    cdef readonly object q, v, mass_matrix, bias, com, com_velocity, angular_momentum
    cdef readonly object base_rotation, base_angular_velocity
    cdef readonly object torso_rotation, torso_position, torso_jacobian, torso_velocity, torso_bias
    cdef readonly object sole_position, sole_rotation, sole_pose, contact_position, contact_rotation
    cdef readonly object contact_jacobian, sole_jacobian, sole_velocity, sole_bias, sole_wrench_map
    cdef readonly JointColumns columns
    cdef Dynamics _dynamics
    cdef object _mass_diagonal
    cdef int _torso_frame
    cdef bint _shifted_left, _shifted_right
    cdef Frame _left, _right, _torso
    cdef double[::1] _q, _v, _c, _c_dot, _L, _h, _linear_momentum, _momentum
    cdef double[::1] _w_base, _w_torso, _bias_torso, _load_force, _load_moment
    cdef double[:, ::1] _M, _J, _W, _J_torso, _p_sole, _p_contact, _v_sole, _bias_sole, _pose
    cdef double[:, :] _R_base, _R_torso
    cdef double[:, :, ::1] _R_sole, _R_contact
    cdef object _to_sole

    cpdef update(self, q, v)
    cpdef bear(self, load)
    cpdef shift_foot(self, Py_ssize_t k, double forward, double pitch)
    cpdef unshift(self, Py_ssize_t k)
    @cython.locals(i=Py_ssize_t, total=double)
    cdef void _update(self)
    @cython.locals(i=Py_ssize_t, h=double[::1], p=vector3, turn=vector3)
    cdef void _place(self)
    @cython.locals(force=double[::1], moment=double[::1])
    cdef void _carry(self, load)
    cdef Frame _sole(self, Py_ssize_t k)
    cdef void _update_sole(self, Py_ssize_t k)
    @cython.locals(pose=double[::1])
    cdef void _place_sole(self, Py_ssize_t k)
    @cython.locals(R_sole=double[:, ::1])
    cdef void _shift(self, Py_ssize_t k, double[:, ::1] R, double[::1] p)
    cdef void _mark(self, Py_ssize_t k, bint shifted)
