"""`hapticd doctor`: what this machine lacks for rendering forces well, and the command that cures it.

Each module examines one thing and yields findings; nothing is changed.
"""

from hapticd.doctor.examination import examine
from hapticd.doctor.finding import Finding, Verdict

__all__ = ["Finding", "Verdict", "examine"]
