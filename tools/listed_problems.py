"""What tools/check_words.py, check_enums.py and check_citations.py share: the root from the command line, a line for each problem, the exit code."""
import pathlib
import sys


def report(problems):
    """Prints problems(root); the root is the first argument, or this checkout. Returns 1 when there are any."""
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[1]
    found = list(problems(root))
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0
