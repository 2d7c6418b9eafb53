from surefoot.planner.references.com_height cimport HeightPreview
from surefoot.planner.references.zmp_reference cimport ZmpReference

cdef class Window:
    cdef readonly ZmpReference reference, driving
    cdef readonly object offset
    cdef readonly HeightPreview height
    cdef readonly object stiffness, omega, load_left, contacts
