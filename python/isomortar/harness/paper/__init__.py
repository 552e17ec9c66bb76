"""The paper's numerical section: its studies, its figures, and its statements with the numbers that measure them."""
