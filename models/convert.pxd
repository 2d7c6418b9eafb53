cimport cython
from surefoot.maths.algebra cimport vector3

ctypedef (vector3, vector3, vector3) rows

cpdef rows rotation(double w, double x, double y, double z) noexcept nogil
@cython.locals(a=vector3, b=vector3, c=vector3, w=double, x=double, y=double, z=double)
cpdef mujoco_to_pinocchio(const double[:] qpos, const double[:] qvel, double[:] q_out, double[:] v_out)
