"""The results of `tools/reproduce.py`. index.py lists them; one module per subject computes them by calling the program (faba.py);
check.py checks the values and page.py writes the page."""
