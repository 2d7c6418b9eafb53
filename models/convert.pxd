cimport cython
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3

@cython.locals(a=vector3, b=vector3, c=vector3, w=double, x=double, y=double, z=double)
cpdef mujoco_to_pinocchio(const double[:] qpos, const double[:] qvel, double[:] q_out, double[:] v_out)
