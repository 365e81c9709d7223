"""`python -m hapticd`: the command line without an installed script."""

from hapticd.cli import main

main()
