cimport cython
from surefoot.wbc.answer cimport AnswerReader
from surefoot.wbc.tasks.balance cimport SupportRegion
from surefoot.wbc.contact.contacts cimport ContactSchedule, ContactState
from surefoot.wbc.dynamics cimport HardConstraints
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference
from surefoot.wbc.body.separation cimport Separation
from surefoot.wbc.qp.solvers cimport QpSolution
from surefoot.wbc.tasks.stack cimport TaskStack
from surefoot.wbc.types cimport FootSensing, WbcAnswer, WbcReport

cdef class WholeBodyController:
    cdef readonly RobotTerms terms
    cdef readonly object layout, qp, driven
    cdef readonly TaskStack tasks
    cdef readonly ContactSchedule schedule
    cdef Separation _separation
    cdef HardConstraints _hard
    cdef readonly SupportRegion region
    cdef ContactState _contacts
    cdef AnswerReader _reader
    cdef object _gap_rows, _gap_lower, _region_contacts, _observer
    cdef double _half_length
    cdef list _seen
    cdef public tuple solvers

    cpdef RobotTerms observe(self, state)
    @cython.locals(terms=RobotTerms, solution=QpSolution, answer=WbcAnswer, contacts=ContactState, iterations=Py_ssize_t, violation=double, dual=double, start=double, built=double)
    cpdef WbcReport update(self, WbcReference reference, FootSensing sensing, bint fail_solvers=*)
    cpdef build(self, RobotTerms terms, WbcReference reference, ContactState contacts)
    cdef _hold(self, RobotTerms terms, ContactState contacts)
    cpdef tuple solve(self, qp, bint fail_solvers=*)
    cpdef WbcAnswer interpret(self, RobotTerms terms, QpSolution solution)
    cdef _shift(self, RobotTerms terms, WbcReference reference, ContactState contacts)
