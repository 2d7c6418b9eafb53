"""``surefoot paper``: the experiments of the paper, run, measured and written as one page."""
