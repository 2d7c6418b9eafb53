"""Whole-body control on a Pinocchio model: tasks, contacts, limits and the inverse-dynamics QP."""
