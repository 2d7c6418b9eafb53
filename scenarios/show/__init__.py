"""The views for people: tables, figures, comparison, replay."""
