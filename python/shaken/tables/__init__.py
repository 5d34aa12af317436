"""What `shaken results` and `shaken plot` do: rows of results, conditions on them, tables."""
