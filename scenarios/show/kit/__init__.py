"""The elements of every report: pages, tables, figures and the shades behind them."""
