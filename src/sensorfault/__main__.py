"""`sensorfault` and `python -m sensorfault`."""

from sensorfault.cli import main

if __name__ == "__main__":
    main()
