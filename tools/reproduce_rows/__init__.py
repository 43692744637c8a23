"""What `tools/reproduce.py` does: index.py lists every result, the modules named after subjects compute them with the program
(faba.py), check.py judges them, page.py shows them."""
