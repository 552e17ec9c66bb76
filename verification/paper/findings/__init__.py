"""The statements of the paper, section by section, in the order of its text."""

from paper.findings import conclusion, iron, parameters, press, tire, twist

STATEMENTS = (*parameters.STATEMENTS, *press.STATEMENTS, *twist.STATEMENTS, *iron.STATEMENTS, *tire.STATEMENTS, *conclusion.STATEMENTS)
