"""The compiling of modules: which, when, and what they run as where they are not."""
