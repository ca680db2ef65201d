# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write doc/parameters.md from what the program itself says about its parameters.

    python3 postprocess/parameter_reference.py build/release/gemmule --output doc/parameters.md
    python3 postprocess/parameter_reference.py build/release/gemmule --check doc/parameters.md

Needs nothing but Python's standard library.
"""

import argparse
import difflib
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

PREFACE = """\
# Parameters

All parameters of a case: what `gemmule --print-parameters` prints, as tables, and what
`gemmule --help-expressions` prints about [expressions](#expressions). This file is generated, and a test
(`parameter_reference`) fails when it differs from the program; after changing a parameter run

    {command}

Parameters outside all sections come first. A heading such as `Membrane/Arclength constraint` is the section
`Arclength constraint` in the section `Membrane`:

    subsection Membrane
      subsection Arclength constraint
        set Model = penalty
      end
    end

which on the command line is `--set "Membrane/Arclength constraint/Model=penalty"`. Everything is dimensionless
but the times of section `Checkpoint`.

A parameter file is plain text in UTF-8. It may also come through a pipe: `gemmule /dev/stdin < case.prm`, a named pipe,
or `gemmule <(COMMAND)` in a shell such as bash. Under `mpirun` rank 0 reads it for all.
"""

EXPRESSIONS = """\
## Expressions

An expression is a formula that the program evaluates at points and times, by muParser. Each part of it is a number
or a condition, and the program refuses what mixes the two: it would have a value, but not the one that is meant.
"""
COMMAND = "python3 postprocess/parameter_reference.py build/release/gemmule --output doc/parameters.md"


class ParameterReferenceError(Exception):
    """The reference cannot be made, or is not up to date; the message is for the user."""


@dataclass
class Parameter:
    section: str  # names joined by slashes, empty at the top level
    key: str
    default: str
    allowed: str
    description: str


def output_of(program, option):
    try:
        done = subprocess.run([program, option], capture_output=True, text=True)
    except OSError as error:
        raise ParameterReferenceError(f"cannot run '{program}' ({error}): build it first, or name another one")
    if done.returncode != 0:
        raise ParameterReferenceError(f"'{program} {option}' failed: {done.stderr.strip()}")
    return done.stdout


def parse_help(text):
    """The headings of the help on expressions, each with its rows: name and meaning, or one cell for a sentence."""
    topics = {}
    for line in text.splitlines()[1:]:
        if line.startswith("  "):
            if not topics:
                raise ParameterReferenceError(f"this line of the help on expressions has no heading: {line}")
            topics[heading].append(re.split(r" {2,}", line.strip(), maxsplit=1))
        elif line:
            heading = line.removesuffix(":")
            topics[heading] = []
    if not topics or not all(topics.values()):
        raise ParameterReferenceError("the program printed no help on expressions")
    return topics


def markdown_of_expressions(topics):
    lines = [EXPRESSIONS]
    for heading, rows in topics.items():
        if lines[-1]:
            lines.append("")
        lines += [f"### {heading}", ""]
        if all(len(row) == 2 for row in rows):
            lines += ["| name | meaning |", "| --- | --- |"]
            lines += [f"| {code(name)} | {cell(meaning)} |" for name, meaning in rows]
        else:
            lines += [f"- {cell(' '.join(row))}" for row in rows]
    return "\n".join(line.removesuffix("\n") for line in lines) + "\n"


def split_description(comment, place):
    """The program ends every description by the allowed values."""
    description, separator, allowed = comment.rpartition(" Expected: ")
    if not separator:
        raise ParameterReferenceError(f"the description of {place} does not say what is expected")
    return description, allowed.removesuffix(".")


def parse(text):
    """The parameters of a parameter file in which each has its description above it, in the order of the file."""
    parameters, sections, comment = [], [], []
    for line in map(str.strip, text.splitlines()):
        assignment = re.fullmatch(r"set (.+?) *= ?(.*)", line)
        if line.startswith("#"):
            comment.append(line[1:].strip())
        elif line.startswith("subsection "):
            sections.append(line[len("subsection ") :])
        elif line == "end":
            sections.pop()
        elif assignment:
            key, value = assignment.groups()
            section = "/".join(sections)
            description, allowed = split_description(" ".join(comment), f"'{section}/{key}'")
            parameters.append(Parameter(section, key, value.strip(), allowed, description))
        elif line:
            raise ParameterReferenceError(f"this line of the printed parameters is not understood: {line}")
        if not line.startswith("#"):
            comment = []
    if not parameters:
        raise ParameterReferenceError("the program printed no parameters")
    # The heading of the whole list stands right above the first description.
    parameters[0].description = re.sub(r"^Listing of Parameters -+ ", "", parameters[0].description)
    return parameters


def cell(text):
    return text.replace("<", "&lt;").replace("*", "\\*").replace("|", "\\|")


def code(text):
    return "`" + text.replace("|", "\\|") + "`" if text else "(empty)"


def markdown(parameters):
    lines = [PREFACE.format(command=COMMAND)]
    section = None
    for parameter in parameters:
        if parameter.section != section:
            section = parameter.section
            lines += ["" if len(lines) > 1 else None, f"## {section or 'Top level'}", ""]
            lines += ["| key | default | allowed | description |", "| --- | --- | --- | --- |"]
        lines.append(
            f"| {cell(parameter.key)} | {code(parameter.default)} | {cell(parameter.allowed)} "
            f"| {cell(parameter.description)} |"
        )
    return "\n".join(line for line in lines if line is not None) + "\n"


def check(path, wanted):
    present = path.read_text(encoding="utf-8")
    if present == wanted:
        return
    changes = difflib.unified_diff(
        present.splitlines(), wanted.splitlines(), str(path), "generated now", lineterm="", n=0
    )
    raise ParameterReferenceError(f"{path} is out of date; run\n    {COMMAND}\n" + "\n".join(changes))


def main(arguments=None):
    parser = argparse.ArgumentParser(description="Turn what gemmule says about its parameters into Markdown tables.")
    parser.add_argument("program", help="the program gemmule")
    action = parser.add_mutually_exclusive_group()
    action.add_argument("--output", type=Path, help="file to write (default: standard output)")
    action.add_argument("--check", type=Path, help="fail if this file is not what would be written")
    options = parser.parse_args(arguments)
    try:
        parameters = parse(output_of(options.program, "--print-parameters"))
        expressions = parse_help(output_of(options.program, "--help-expressions"))
        text = markdown(parameters) + "\n" + markdown_of_expressions(expressions)
        if options.check:
            check(options.check, text)
        elif options.output:
            options.output.write_text(text, encoding="utf-8")
        else:
            sys.stdout.write(text)
    except (ParameterReferenceError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
