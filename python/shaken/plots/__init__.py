"""Figures of numbers, by matplotlib, in one style.

    from shaken.plots import names, style
    sheet = style.sheet(width="89mm")
    panel = sheet.panels[0]
    panel.titles(x=names.axis_title("rods.area_fraction"), y=names.axis_title("order.mean"))
    panel.curve(phi, order, error=error, steady=steady, label="ℓ = 4.6 mm")
    sheet.save("order.pdf", {"Software": "..."})      # and order.csv with the numbers
"""
