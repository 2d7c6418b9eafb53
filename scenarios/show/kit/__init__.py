"""What every report is made of: pages, tables, figures and the shades behind them."""
