"""The paper's figures, drawn anew from logs."""
