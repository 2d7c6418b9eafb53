from surefoot.maths.algebra cimport vector3

cdef class WbcReference:
    cdef vector3 _c, _c_dot, _c_ddot, _s, _s_dot, _s_ddot, _w, _w_dot
    cdef (double, double) _p, _o
    cdef (vector3, vector3, vector3) _R
    cdef (vector3, vector3) _n
    cdef readonly double omega, stiffness, heading, heading_rate, time_to_switch, swing_progress
    cdef readonly int lifting_foot, swing_foot
    cdef readonly bint catching
    cdef readonly object planned_contact
    cdef readonly (double, double) load_share
    cdef readonly (Py_ssize_t, Py_ssize_t) edge
    cdef readonly (vector3, vector3) roll
    cdef readonly vector3 pelvis_yaw, pelvis_list

cdef vector3 _vector(values)
cdef (double, double) _point(values)
