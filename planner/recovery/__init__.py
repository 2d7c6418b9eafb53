"""Steps changed in place and time, so that the DCM is captured."""
