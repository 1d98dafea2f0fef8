"""The table of docs/can.md from measured.csv files: fault, ms until it is noticed, last moving command,
first zero command, way to rest in mm."""
import csv
import math
import sys


def cell(texts):
    values = sorted(float(text) for text in texts if text)
    if not values:
        return "-"
    ranks = [values[max(math.ceil(share * len(values)) - 1, 0)] for share in (0.5, 0.99, 1.0)]
    return " / ".join(f"{value:.0f}" for value in ranks)


rows = {}
for file in sys.argv[1:]:
    with open(file, newline="") as lines:
        for fault, *measures in csv.reader(lines):
            rows.setdefault(fault, []).append(measures)

print("| fault | times | noticed (ms) | last moving command (ms) | first zero command (ms) | way to rest (mm) |")
print("|---|---|---|---|---|---|")
for fault, measures in rows.items():
    columns = " | ".join(cell(column) for column in zip(*measures))
    print(f"| {fault} | {len(measures)} | {columns} |")
