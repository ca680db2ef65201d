# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tables of doc/parameters.md from what the program prints."""

import unittest

from postprocess import parameter_reference

HELP = """\
Expressions in parameters

Constants:
  pi                      circumference over diameter

Operators:
  c ? a : b               a where c holds
  ||                      or: one of them * holds
  < <= > >= == !=         comparisons

Rules:
  Write 2*x, not 2x.
"""


class HelpOnExpressions(unittest.TestCase):
    def test_rows_have_name_and_meaning(self):
        topics = parameter_reference.parse_help(HELP)
        self.assertEqual(list(topics), ["Constants", "Operators", "Rules"])
        self.assertEqual(topics["Constants"], [["pi", "circumference over diameter"]])
        self.assertEqual(topics["Operators"][2], ["< <= > >= == !=", "comparisons"])
        self.assertEqual(topics["Rules"], [["Write 2*x, not 2x."]])

    def test_tables_and_sentences(self):
        text = parameter_reference.markdown_of_expressions(parameter_reference.parse_help(HELP))
        self.assertIn("### Constants\n\n| name | meaning |\n| --- | --- |\n| `pi` | circumference", text)
        self.assertIn("| `\\|\\|` | or: one of them \\* holds |", text)
        self.assertIn("### Rules\n\n- Write 2\\*x, not 2x.\n", text)

    def test_nothing_is_an_error(self):
        for text in ("", "Title\n", "Title\n\nConstants:\n\n", "Title\n  pi   a number\n"):
            with self.assertRaises(parameter_reference.ParameterReferenceError):
                parameter_reference.parse_help(text)


if __name__ == "__main__":
    unittest.main()
