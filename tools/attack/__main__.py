"""Attacks vdbeam: damaged files of every kind, wild commands, kills, and pipes in place of files.

    tools/attack.sh --mutants 10000                   damaged files and commands, of all kinds in turn
    tools/attack.sh --mutants 1000 --kind volume --seed 5000
    tools/attack.sh --one volume:5017                 one mutant again, as a breach names it
    tools/attack.sh --hours 8                         mutants for eight hours
    tools/attack.sh --kills 200                       kills at chosen calls and at random moments
    tools/attack.sh --pipes                           pipes, devices, sockets, folders and loops of links as files
    tools/attack.sh --prepare                         only the sound files, which later campaigns find

Each command has 2 GiB of memory and 20 s; it must end with 0, 2 or 3 and a line, and leave inputs as they are and no
half file. Exit status: 1 where one did not.
"""
import argparse
import sys

import campaign
import kills
import pipes


def parse():
    parser = argparse.ArgumentParser(prog="attack.sh", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mutants", type=int, default=0, metavar="N")
    parser.add_argument("--kind", action="append", help="only this one; may be repeated")
    parser.add_argument("--seed", type=int, default=1, help="number of the first mutant of each kind")
    parser.add_argument("--hours", type=float)
    parser.add_argument("--one", metavar="KIND:NUMBER")
    parser.add_argument("--kills", type=int, default=0, metavar="N")
    parser.add_argument("--pipes", type=int, nargs="?", const=sys.maxsize, metavar="N", help="about N of them; default: all")
    parser.add_argument("--prepare", action="store_true")
    parser.add_argument("--keep", metavar="FOLDER", help="where files of breaches go")
    return parser.parse_args()


def attack(options):
    """The number of breaches."""
    count = 0
    if options.mutants or options.hours or options.one or options.pipes or options.prepare:
        here = campaign.Campaign(options.keep)
        try:
            if options.one:
                kind, _, number = options.one.partition(":")
                print(here.run(here.targets.make(kind, int(number))) or "nothing is wrong")
            if options.mutants or options.hours:
                here.mutants(options.kind or here.targets.kinds, options.mutants or sys.maxsize, options.seed,
                             options.hours)
            if options.pipes:
                pipes.attack(here, options.pipes)
        finally:
            here.close()
        count += len(here.breaches)
    if options.kills:
        count += kills.attack(options.kills, options.seed)
    return count


if __name__ == "__main__":
    sys.exit(1 if attack(parse()) else 0)
