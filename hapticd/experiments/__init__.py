"""The figures of the two papers as experiments that anyone can run."""
