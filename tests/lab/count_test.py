#!/usr/bin/env python3
"""usage: count_test.py TOOLS_COUNT COUNTED_LOOP: what tools/count says about loops of known length, to the instruction."""
import json
import subprocess
import sys
import tempfile

SLACK = 100e-6  # Minstr that a mark may cost


def expect(what, value, wanted, marks=1):
    if not wanted - 1e-9 <= value <= wanted + marks * SLACK:
        sys.exit(f'{what}: {value} Minstr, expected {wanted}')


def main():
    tool, program = sys.argv[1:]
    with tempfile.NamedTemporaryFile(suffix='.json') as file:
        subprocess.run([tool, '--json', file.name, '--', program], check=True, stdout=subprocess.DEVNULL)
        result = json.load(file)
    if result.get('config_sha256') != '0f' * 32:
        sys.exit('the hash of the configuration that the command printed is not there')
    stages = result['stages']
    expect('labels, mean', stages['labels']['mean_minstr'], 4.0)
    expect('labels, worst', stages['labels']['worst_minstr'], 6.0)
    expect('search, mean', stages['search']['mean_minstr'], 0.2)
    expect('search, worst', stages['search']['worst_minstr'], 0.2)
    # A stage of another thread is booked on the images during which it ended; its sum is what it is.
    expect('beside, sum', stages['beside']['mean_minstr'] * stages['beside']['images'], 2.0, marks=4)
    total = sum(s['mean_minstr'] * s['images'] for s in stages.values())
    expect('images, sum', result['image']['mean_minstr'] * result['images'], total)

    failed = subprocess.run([tool, '--', '/bin/true'], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if failed.returncode == 0 or 'no stage' not in failed.stderr:
        sys.exit('a command without stages must be an error')
    print('tools/count is exact')


if __name__ == '__main__':
    main()
