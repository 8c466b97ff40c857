"""libRSF's text, written by hand after its document."""

from fuzz.writing import EPOCHS, text_file


def librsf() -> str:
    """Two satellites and an odometer."""
    rows = []
    for k in range(EPOCHS):
        rows.append(f"odom3 {0.2 * k:.14g} {5 + 0.1 * k} 0 0 0 0 {-0.01 * k} 1 1 1 1 1 1\n")
        rows += [
            f"pseudorange3 {0.2 * k:.14g} {2e7 + 10 * k} 25 1.4e7 {2.8e6 + k} 2.2e7 {number} {system} 45.5 40\n"
            for number, system in ((12, 1), (320, 4))
        ]
    return "".join(rows)


SMALL = {"libRSF measurements": text_file("car_Input.txt", librsf)}
