"""The three verdicts, in order: the verdict on a sensor is the largest over its channels."""

OK, UNKNOWN, FAULT = 0, 1, 2
VERDICTS = ("ok", "unknown", "fault")
