cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3

@cython.locals(x=vector3, y=vector3, z=vector3)
cpdef void turn_sole(vector3 angles, double[:, :] R) noexcept nogil
@cython.locals(cy=double, cp=double, cr=double, sy=double, sp=double, sr=double)
cpdef (vector3, vector3, vector3) rows(vector3 angles) noexcept nogil
@cython.locals(turn=double, tilt=double, lean=double)
cpdef vector3 sole_spin(vector3 angles, vector3 rates) noexcept nogil
@cython.locals(turn=double, tilt=double, lean=double, turn2=double, tilt2=double, lean2=double)
cpdef vector3 sole_spin_rate(vector3 angles, vector3 rates, vector3 accelerations) noexcept nogil
@cython.locals(R=double[:, ::1])
cpdef void roll_sole(const double[:] level, const double[:] rates, double pivot, double pitch, double rate, double[:] centre, double[:] velocity) noexcept
