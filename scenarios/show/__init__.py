"""What people look at: tables, figures, comparison, replay."""
