"""The commands; each imports its modules when called, so that help appears at once."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

import typer

from ..checks import ArgumentError
from ..version import __version__
from .exits import FAILED, GOOD, INTERRUPTED, Stopped

app = typer.Typer(
    help="Friction noise in the time domain: squeal, squeak and judder of elastic bodies in exact contact.",
    pretty_exceptions_enable=False,
)


def _shipped(beginning: str) -> list[str]:
    """Return the shipped scenarios that complete a word; the shell completes files itself."""
    from ..scenarios.shipped import shipped

    return [name for name in shipped("cases") if name.startswith(beginning)]


NameOrFile = Annotated[
    str,
    typer.Argument(
        metavar="NAME-OR-FILE",
        help="A shipped scenario, a TOML file, a record, or - for standard input.",
        autocompletion=_shipped,
    ),
]

TextFile = Annotated[
    str | None, typer.Option("--out", metavar="FILE", help="Write to a file, in UTF-8, instead of printing.")
]

Record = Annotated[str, typer.Argument(metavar="RUN.nc", help="A record.")]
Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a value, given by its full key or any unique ending of it; may be repeated.",
    ),
]
Duration = Annotated[str | None, typer.Option(metavar="S", help="Time to simulate, in s or with a unit.")]
SlipVelocity = Annotated[
    str | None,
    typer.Option(
        metavar="M/S", help="Slip velocity where nothing prescribes it; one for each contact, separated by commas."
    ),
]

# Options shared by the commands that compute many points.
Vary = Annotated[
    list[str] | None,
    typer.Option(metavar="KEY=START:STOP:COUNT", help="Vary a value, ends included, or KEY=A,B,C; may be repeated."),
]
Sample = Annotated[
    int | None, typer.Option(metavar="N", help="Sample N points of a Latin hypercube over the ranges KEY=START:STOP.")
]
SampleSeed = Annotated[int | None, typer.Option(metavar="S", help="Seed of --sample; default: 0.")]
PointsFile = Annotated[
    str | None,
    typer.Option(metavar="FILE.csv", help="Read the points from a table: a row of keys, then one row for each point."),
]
SetEverywhere = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change a value at every point; may be repeated."),
]
Workers = Annotated[int | None, typer.Option(metavar="N", help="Parts computed at a time.")]
Scheduler = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Compute on other machines through a dask scheduler, tcp://host:port."),
]
ManyPoints = Annotated[bool, typer.Option("--yes", help="Confirm more than 10 000 points.")]


@app.callback(invoke_without_command=True)
def start(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
) -> None:
    """Friction noise in the time domain: squeal, squeak and judder of elastic bodies in exact contact."""
    if version:
        print(f"stridula {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        print(context.get_help())


@app.command("list")
def list_() -> None:
    """List the shipped scenarios."""
    from ..scenarios.shipped import list_scenarios

    cases = list_scenarios()
    names, titles = (max(len(getattr(case, word)) for case in cases) for word in ("name", "title"))
    for case in cases:
        print(f"{case.name:<{names}}  {case.title:<{titles}}  {case.source}")


@app.command()
def show(
    name: NameOrFile,
    out: TextFile = None,
    plot: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Draw the system instead, before its run, in space in perspective."),
    ] = None,
) -> None:
    """Print a scenario as TOML, to copy and edit, or draw its system; doubtful values go to standard error."""
    from pathlib import Path

    from ..scenarios.show import scenario_text
    from .consoles import put

    if plot is not None:
        from .drawing import draw_system

        draw_system(name, plot, out)
    if plot is None or out is not None:
        put(scenario_text(name), out)
    # Shipped scenarios have no doubtful values, and need no compiler to be shown.
    if Path(name).is_file():
        from .doubts import say_doubts

        say_doubts(name)


@app.command()
def schema(out: TextFile = None) -> None:
    """Print the JSON schema of scenario files, for editors."""
    import json

    from ..scenarios.show import scenario_schema
    from .consoles import put

    put(json.dumps(scenario_schema(), indent=2, ensure_ascii=False) + "\n", out)


@app.command()
def run(
    name: NameOrFile,
    set_: Set = None,
    duration: Duration = None,
    out: Annotated[str | None, typer.Option(metavar="FILE", help="Write the record, as NetCDF.")] = None,
    plot: Annotated[
        str | None, typer.Option(metavar="FILE", help="Draw the record; the file extension gives the format.")
    ] = None,
    wav: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the sound at two ears a metre above the track, as WAV.")
    ] = None,
    check_step: Annotated[
        bool, typer.Option("--check-step", help="Run it again at half the step and print how far the results move.")
    ] = False,
) -> None:
    """Run a scenario and print the regime, pitch, forces and energies."""
    with _importing():
        from .running import run_scenario

    overrides = _pairs(set_ or [])
    if duration is not None:
        overrides["simulation.duration"] = duration
    run_scenario(name, overrides, out, plot, wav, check_step)


@app.command()
def sound(
    record: Record,
    listener: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y,Z", help="Position of a listener, in m; may be repeated; default: two ears 1 m above."
        ),
    ] = None,
    body: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="A body to include in the sound; may be repeated; default: all that radiate."
        ),
    ] = None,
    wav: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the sound, one channel for each listener.")
    ] = None,
    plot: Annotated[
        str | None, typer.Option(metavar="FILE", help="Draw the spectrogram at the first listener.")
    ] = None,
    bands: Annotated[
        str | None, typer.Option(metavar="FILE", help="Draw levels in third-octave bands, a line for each listener.")
    ] = None,
    sample_rate: Annotated[
        str, typer.Option(metavar="HZ", help="Sample rate of the sound file: 44.1, 48 or 96 kHz.")
    ] = "48 kHz",
    full_scale: Annotated[
        str, typer.Option(metavar="PA", help="Pressure at full scale, or `normalised`: 1 dB above the peak.")
    ] = "normalised",
    subtype: Annotated[str, typer.Option(metavar="WORD", help="Format of the samples: PCM_24 or FLOAT.")] = "PCM_24",
    baffled: Annotated[
        bool | None,
        typer.Option(
            "--baffled/--unbaffled",
            help="Flat tracks in an infinite wall, or in free air; default: in a wall in the plane, free in space.",
        ),
    ] = None,
) -> None:
    """Print the sound levels of a record at listeners, and write the sound as WAV."""
    from .sounding import sound_of_record

    figures = {"--plot": plot, "--bands": bands}
    sound_of_record(
        record,
        listener or [],
        body or [],
        wav=wav,
        figures=figures,
        sample_rate=sample_rate,
        full_scale=full_scale,
        subtype=subtype,
        baffled=baffled,
    )


@app.command()
def sweep(
    name: NameOrFile,
    measure: Annotated[list[str], typer.Option(metavar="NAME", help="A measure of each run; may be repeated.")],
    out: Annotated[str, typer.Option(metavar="FILE", help="Write the measures of all points, as NetCDF.")],
    vary: Vary = None,
    sample: Sample = None,
    seed: SampleSeed = None,
    points: PointsFile = None,
    set_: SetEverywhere = None,
    duration: Duration = None,
    plot: Annotated[str | None, typer.Option(metavar="FILE", help="Draw a map of the regimes over two keys.")] = None,
    workers: Annotated[
        int | None, typer.Option(metavar="N", help="Parts computed at a time; default: one per processor.")
    ] = None,
    scheduler: Scheduler = None,
    yes: ManyPoints = False,
) -> None:
    """Run a scenario at many parameter points and keep measures of each run; resumes after an interruption."""
    with _importing():
        from .points import points_of
        from .sweeping import sweep_scenario

    chosen = points_of(vary or [], sample, seed, points, yes)
    overrides = _pairs(set_ or [])
    print(
        sweep_scenario(
            name,
            chosen,
            measure,
            overrides,
            duration=duration,
            out=out,
            plot=plot,
            workers=workers,
            scheduler=scheduler,
        )
    )


@app.command()
def survey(
    name: NameOrFile,
    out: Annotated[str, typer.Option("--out", "-o", metavar="FILE", help="Write modes and fates, as NetCDF.")],
    vary: Vary = None,
    sample: Sample = None,
    seed: SampleSeed = None,
    points: PointsFile = None,
    set_: SetEverywhere = None,
    duration: Annotated[
        str | None, typer.Option(metavar="S", help="Time of each run; default: from the growth rate.")
    ] = None,
    longest: Annotated[str, typer.Option(metavar="S", help="Longest time of a run, without --duration.")] = "1 s",
    amplitude: Annotated[
        float,
        typer.Option(
            metavar="X", help="Initial amplitude of a mode, relative to that at which a contact opens, stops or slips."
        ),
    ] = 1e-3,
    highest: Annotated[
        str | None, typer.Option(metavar="HZ", help="Count modes above this frequency, but do not simulate them.")
    ] = None,
    velocity: SlipVelocity = None,
    cycles: Annotated[bool, typer.Option(help="Search limit cycles at the ends of runs directly.")] = True,
    kicks: Annotated[
        int, typer.Option(metavar="N", min=0, help="Decaying modes that are kicked where no mode grows.")
    ] = 1,
    by: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY", help="Differentiate the growing modes by a parameter; may be repeated."),
    ] = None,
    plot: Annotated[str | None, typer.Option(metavar="FILE", help="Draw a map of squeal over two keys.")] = None,
    table: Annotated[
        str | None, typer.Option(metavar="FILE.csv", help="Write a row for each mode of each point.")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(metavar="N", help="Points computed at a time; default: one per processor.")
    ] = None,
    scheduler: Scheduler = None,
    yes: ManyPoints = False,
) -> None:
    """Find the growing modes of sliding at many points and simulate each in time; resumes after an interruption."""
    with _importing():
        from .points import points_of
        from .stability import velocities
        from .surveying import survey_scenario

    chosen = points_of(vary or [], sample, seed, points, yes)
    lines = survey_scenario(
        name,
        chosen,
        out,
        plot,
        table,
        scheduler,
        overrides=_pairs(set_ or []),
        duration=duration,
        longest=longest,
        amplitude=amplitude,
        highest=highest,
        velocity=velocities(velocity),
        cycles=cycles,
        kicks=kicks,
        by=by or [],
        workers=workers,
    )
    print(lines)


@app.command()
def stability(
    name: NameOrFile,
    set_: Set = None,
    status: Annotated[
        str | None,
        typer.Option(
            metavar="WORD",
            help="Status of the contacts: sliding, sticking or separated; one for each, separated by commas.",
        ),
    ] = None,
    velocity: SlipVelocity = None,
    vary: Annotated[
        str | None,
        typer.Option(
            metavar="KEY=START:STOP:COUNT", help="Track the modes over a parameter and find where stability changes."
        ),
    ] = None,
    highest: Annotated[
        float | None, typer.Option(metavar="HZ", help="With --vary or --random: leave out modes above this frequency.")
    ] = None,
    by: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY", help="Effect of a parameter on the growing mode, or of all of them; may be repeated."
        ),
    ] = None,
    random: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=LOW:HIGH",
            help="Probability of growth for a random parameter, uniform or KEY=normal:MEAN:DEVIATION; may be repeated.",
        ),
    ] = None,
    correlation: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY,KEY=NUMBER", help="With --random: correlation of two parameters; may be repeated."),
    ] = None,
    samples: Annotated[
        int | None, typer.Option(metavar="N", help="With --random: number of points; default: 1000.")
    ] = None,
    seed: Annotated[int | None, typer.Option(metavar="S", help="With --random: seed of the points.")] = None,
    workers: Workers = None,
    plot: Annotated[
        str | None, typer.Option(metavar="FILE", help="Draw modes over a parameter, effects, or probabilities.")
    ] = None,
    out: Annotated[str | None, typer.Option(metavar="FILE", help="Write these, as NetCDF.")] = None,
) -> None:
    """Print equilibrium and modes of sliding by linear theory, where stability changes, effects or probabilities."""
    overrides = _pairs(set_ or [])
    sampled = {"--correlation": correlation, "--samples": samples, "--seed": seed, "--workers": workers}
    if random:
        unused = {"--vary": vary, "--by": by, "--status": status}
        if option := next((option for option, value in unused.items() if value), None):
            raise ArgumentError(option, "be left out with --random", unused[option])
        from .probability import print_probability
        from .stability import velocities

        print_probability(
            name,
            random,
            correlation or [],
            overrides,
            out,
            plot,
            velocity=velocities(velocity),
            highest=highest,
            samples=1000 if samples is None else samples,
            seed=seed or 0,
            workers=workers,
        )
        return
    if alone := next((option for option, value in sampled.items() if value is not None), None):
        raise ArgumentError(alone, "be used with --random", sampled[alone], got=f"{sampled[alone]!r} alone")
    if by:
        for option, value in (("--vary", vary), ("--highest", highest)):
            if value is not None:
                raise ArgumentError(option, "be left out with --by", value)
        from .effects import print_effects
        from .stability import statuses, velocities

        print_effects(name, by, overrides, out, plot, status=statuses(status), velocity=velocities(velocity))
        return
    if vary is None:
        for option, value in (("--plot", plot), ("--out", out), ("--highest", highest)):
            if value is not None:
                others = "--vary or --random" if option == "--highest" else "--vary, --by or --random"
                raise ArgumentError(option, f"be used with {others}", value, got=f"{value!r} alone")
        from .stability import print_stability

        print_stability(name, overrides, status, velocity)
        return
    from .loci import print_loci
    from .stability import statuses, velocities

    options = {"status": statuses(status), "velocity": velocities(velocity)}
    print_loci(name, vary, overrides, highest, out, plot, **options)


@app.command("report")
def report_(
    names: Annotated[
        list[str],
        typer.Argument(metavar="NAME-OR-FILE", help="One or two scenarios, files or records.", autocompletion=_shipped),
    ],
    out: Annotated[str, typer.Option(metavar="FILE.html", help="Page to write.")],
    set_: Set = None,
    duration: Duration = None,
    vary: Annotated[
        str | None,
        typer.Option(metavar="KEY=START:STOP:COUNT", help="Range of the root loci; default: all friction."),
    ] = None,
    random: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=LOW:HIGH", help="An uncertain parameter, as for stability; may be repeated."),
    ] = None,
    change: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=LOW:HIGH", help="A parameter of the smallest change that silences it, in SI; may be repeated."
        ),
    ] = None,
    samples: Annotated[int, typer.Option(metavar="N", help="With --random: number of points.")] = 1000,
    status: Annotated[str | None, typer.Option(metavar="WORD", help="Status of contacts, as for stability.")] = None,
    velocity: SlipVelocity = None,
    run: Annotated[bool, typer.Option(help="Run it in time.")] = True,
    sound: Annotated[bool, typer.Option(help="Compute its sound.")] = True,
    effects: Annotated[bool, typer.Option(help="Compute effects of parameters.")] = True,
    check: Annotated[bool, typer.Option(help="Check step and cutoffs.")] = True,
    fates: Annotated[
        bool, typer.Option("--fates", help="Follow each growing mode in time to its regime, pitch and level.")
    ] = False,
) -> None:
    """Write a page on a system, or on two designs: modes, run, sound, and what helps."""
    with _importing():
        from .reporting import report_scenarios

    print(
        report_scenarios(
            names,
            out,
            _pairs(set_ or []),
            vary=vary,
            change=change or [],
            random=random or [],
            status=status,
            velocity=velocity,
            duration=duration,
            samples=samples,
            run=run,
            sound=sound,
            effects=effects,
            check=check,
            fates=fates,
        )
    )


CycleStart = Annotated[
    str | None,
    typer.Option("--from", metavar="RUN.nc", help="Start from a record; else from a run of the scenario."),
]
ModeAmplitude = Annotated[
    str | None, typer.Option(metavar="M", help="Start from the mode that grows fastest, with this amplitude.")
]


@app.command()
def cycle(
    name: NameOrFile,
    set_: Set = None,
    from_: CycleStart = None,
    amplitude: ModeAmplitude = None,
    frequency: Annotated[str | None, typer.Option(metavar="HZ", help="Expected frequency of the cycle.")] = None,
    out: Annotated[str | None, typer.Option(metavar="FILE", help="Write the record of the cycle, as NetCDF.")] = None,
    plot: Annotated[str | None, typer.Option(metavar="FILE", help="Draw the Floquet multipliers.")] = None,
) -> None:
    """Find a limit cycle directly: its frequency, amplitude and stability."""
    with _importing():
        from .cycling import Begin, print_cycle

    print_cycle(name, _pairs(set_ or []), Begin(from_, amplitude), frequency, out, plot)


@app.command()
def follow(
    name: NameOrFile,
    over: Annotated[str, typer.Option(metavar="KEY=LOW:HIGH", help="Parameter and its range.")],
    at: Annotated[str | None, typer.Option(metavar="VALUE", help="Value at the first cycle; default: LOW.")] = None,
    set_: Set = None,
    from_: CycleStart = None,
    amplitude: ModeAmplitude = None,
    points: Annotated[int, typer.Option(metavar="N", help="Most points in each direction.")] = 100,
    out: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the branch, as NetCDF; continued if it was begun.")
    ] = None,
    plot: Annotated[str | None, typer.Option(metavar="FILE", help="Draw the branch.")] = None,
) -> None:
    """Follow a limit cycle over a parameter, through folds, with its stability."""
    with _importing():
        from .cycling import Begin, Over, print_branch

    print_branch(name, _pairs(set_ or []), Over(over, at, points), Begin(from_, amplitude), out, plot)


@app.command()
def animate(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME-OR-RUN.nc", help="A shipped scenario, a TOML file or a record, which is run again."
        ),
    ],
    out: Annotated[str, typer.Option(metavar="FILE", help="Film to write: .mp4 or .gif.")],
    from_: Annotated[str, typer.Option("--from", metavar="S", help="Start of the film, in s or with a unit.")] = "0",
    duration: Annotated[str, typer.Option(metavar="S", help="Time shown in the film, in s or with a unit.")] = "10 ms",
    slowdown: Annotated[float, typer.Option(metavar="X", help="Factor of slow motion.")] = 1000.0,
    exaggeration: Annotated[
        float | None, typer.Option(metavar="X", help="Factor by which the vibration is enlarged.")
    ] = None,
    elevation: Annotated[str, typer.Option(metavar="ANGLE", help="In space, elevation of the viewpoint.")] = "30 deg",
    azimuth: Annotated[
        str, typer.Option(metavar="ANGLE", help="In space, azimuth of the viewpoint, from z towards x.")
    ] = "35 deg",
) -> None:
    """Film the bodies and their contacts in slow motion."""
    from .filming import film_scenario

    print(film_scenario(name, out, from_, duration, slowdown, exaggeration, (elevation, azimuth)))


@app.command()
def mesh(
    file: Annotated[str, typer.Argument(metavar="FILE", help="A mesh file or a deck.")],
    scale: Annotated[str, typer.Option(metavar="M", help="Length of its unit, in m or with a unit: 1 mm.")] = "1",
    part: Annotated[str | None, typer.Option(metavar="NAME", help="Show only this part.")] = None,
    plot: Annotated[str | None, typer.Option(metavar="FILE", help="Draw the parts in perspective.")] = None,
) -> None:
    """Print the parts of a mesh file: sizes, elements, groups, materials and quality."""
    from .meshes import print_mesh

    print_mesh(file, scale, part, plot)


@app.command()
def signal(
    files: Annotated[list[str], typer.Argument(metavar="FILE...", help="Recordings: sounds, tables, universal files.")],
    channel: Annotated[str | None, typer.Option(metavar="NAME", help="Read only this channel.")] = None,
    calibration: Annotated[
        str | None, typer.Option(metavar="X", help="Value of a sample of 1, of full scale for sounds; needs --units.")
    ] = None,
    units: Annotated[str | None, typer.Option(metavar="UNIT", help="Units of the channel, such as Pa or m/s2.")] = None,
    sample_rate: Annotated[
        str | None, typer.Option(metavar="HZ", help="Sample rate of files that do not state it.")
    ] = None,
    lowest: Annotated[
        str | None, typer.Option(metavar="HZ", help="Lowest frequency of squeals; default: 1.25 kHz.")
    ] = None,
    out: Annotated[str | None, typer.Option(metavar="FILE.csv", help="Write the squeals, a row for each.")] = None,
    plot: Annotated[str | None, typer.Option(metavar="FILE", help="Draw the squeals, level over frequency.")] = None,
) -> None:
    """Print what recordings are: channels, levels, tones, regime and squeals."""
    from .recordings import print_signals

    options = {"--calibration": calibration, "--units": units, "--sample-rate": sample_rate, "--lowest": lowest}
    print_signals(files, channel, options, out, plot)


@app.command()
def export(
    record: Record,
    out: Annotated[str, typer.Option(metavar="FILE", help="Table to write: .csv or .mat.")],
) -> None:
    """Write a record as a table for other programs."""
    from ..records.export import export as write_table
    from ..records.files import load

    write_table(load(record), out)


@app.command()
def compare(
    first: Annotated[str, typer.Argument(metavar="A.nc", help="A record.")],
    second: Annotated[str, typer.Argument(metavar="B.nc", help="Another record with the same sampling.")],
    tolerance: Annotated[
        float, typer.Option(metavar="X", help="Largest accepted difference, relative to the largest value in A.")
    ] = 1e-6,
) -> int:
    """Print the differences between two records; exit with 1 if one exceeds the tolerance."""
    from .comparing import print_comparison

    return GOOD if print_comparison(first, second, tolerance) else FAILED


@app.command("calibrate")
def calibrate_(
    name: NameOrFile,
    vary: Annotated[
        list[str],
        typer.Option(
            metavar="KEY=LOW:HIGH",
            help="Range of a parameter; KEY=LOW:HIGH:log for a logarithmic scale; may be repeated.",
        ),
    ],
    target: Annotated[
        list[str],
        typer.Option(
            metavar="NAME=LOW:HIGH",
            help="Bounds of a measure, either may be left out, or NAME=WORD; may be repeated.",
        ),
    ],
    set_: SetEverywhere = None,
    duration: Duration = None,
    population: Annotated[int, typer.Option(metavar="N", help="Parameter sets in each generation.")] = 32,
    generations: Annotated[int, typer.Option(metavar="N", help="Largest number of generations.")] = 50,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the search.")] = 0,
    out: Annotated[str | None, typer.Option(metavar="FILE", help="Write the best set as a scenario, TOML.")] = None,
    search: Annotated[
        str | None, typer.Option(metavar="FILE", help="Keep the search, NetCDF; the same command resumes it.")
    ] = None,
    workers: Workers = None,
) -> int:
    """Search for parameters whose run meets given targets; exit with 1 if a target is not met."""
    from .points import ranges_of
    from .searching import calibrate_scenario

    met = calibrate_scenario(
        name,
        ranges_of(vary),
        target,
        _pairs(set_ or []),
        out,
        search=search,
        duration=duration,
        population=population,
        generations=generations,
        seed=seed,
        workers=workers,
    )
    return GOOD if met else FAILED


@app.command("sensitivity")
def sensitivity_(
    name: NameOrFile,
    vary: Annotated[
        list[str],
        typer.Option(
            metavar="KEY=LOW:HIGH", help="An uncertain parameter, uniform between LOW and HIGH; may be repeated."
        ),
    ],
    measure: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A measure of each run; default: the regime; may be repeated."),
    ] = None,
    set_: SetEverywhere = None,
    duration: Duration = None,
    samples: Annotated[
        int, typer.Option(metavar="N", help="Base samples, a power of 2; N (parameters + 2) runs are computed.")
    ] = 256,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the points.")] = 0,
    out: Annotated[str | None, typer.Option(metavar="FILE", help="Write the indices, as NetCDF.")] = None,
    workers: Workers = None,
    yes: ManyPoints = False,
) -> None:
    """Rank uncertain parameters by their effect, and print the probability of each regime."""
    from .points import check_count, ranges_of
    from .searching import sensitivity_of_scenario

    ranges = ranges_of(vary)
    check_count(samples * (len(ranges) + 2), yes)
    line = sensitivity_of_scenario(
        name,
        ranges,
        measure or [],
        _pairs(set_ or []),
        out,
        duration=duration,
        samples=samples,
        seed=seed,
        workers=workers,
    )
    print(line)


@app.command()
def paper(
    out: Annotated[str, typer.Option(metavar="DIR", help="Folder to write to.")] = "results/paper",
) -> None:
    """Reproduce Laulagnet 2011: figures, records, sounds and claims."""
    from pathlib import Path

    from ..integration import Diverged
    from ..papers.laulagnet_2011.reproduce import closing_line, reproduce

    try:
        rows = reproduce(Path(out), report=lambda line: print(line, file=sys.stderr, flush=True))
    except KeyboardInterrupt:
        raise Stopped(f"interrupted; finished files are in {out}", INTERRUPTED) from None
    except Diverged as error:
        raise Stopped(f"{error}; finished files are in {out}", FAILED) from None
    print(closing_line(rows))


@app.command()
def verify(
    out: Annotated[str, typer.Option(metavar="DIR", help="Folder to write to.")] = "results/verify",
    only: Annotated[
        str | None, typer.Option(metavar="WORD", help="Run only the cases with this word in their name or title.")
    ] = None,
) -> None:
    """Run every case with a known answer and compare each scheme with it."""
    from ..verification import closing_line
    from ..verification import verify as run_cases
    from .verifying import interrupted_at_once, print_rows

    try:
        with interrupted_at_once():
            rows = run_cases(out, only, report=lambda line: print(line, file=sys.stderr, flush=True))
    except KeyboardInterrupt:
        raise Stopped(f"interrupted; figures of the finished cases are in {out}", INTERRUPTED) from None
    print_rows(rows)
    if not all(row["holds"] for row in rows):
        raise Stopped(closing_line(rows), FAILED)
    print(f"{closing_line(rows)}; written to {out}")


def _pairs(texts: list[str]) -> dict[str, str]:
    return dict(_pair(text) for text in texts)


def _pair(text: str) -> tuple[str, str]:
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise ArgumentError("--set", "be KEY=VALUE", text)
    return key.strip(), value.strip()


@app.command("app")
def app_(
    host: Annotated[str, typer.Option(metavar="H", help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(metavar="N", help="Port; 0 for any free one.")] = 8707,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Print the address only.")] = False,
    open_: Annotated[
        bool, typer.Option("--open", help="Let other machines connect; needed if --host is not this machine.")
    ] = False,
) -> None:
    """Serve a page in the browser to play the contact: change the friction and hear it squeal."""
    with _importing():
        from ..app.serve import serve

    serve(host, port, open_, not no_browser)


@contextmanager
def _importing() -> Iterator[None]:
    """Import without garbage collection, and exclude the imported objects from later collections."""
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()
