"""Signals in files: what others write is read, what is written others read, and bad lines are named."""

from __future__ import annotations

import struct

import numpy as np
import pandas
import pytest
import soundfile
import xarray as xr

import stridula as st
from stridula.doubtful import DoubtfulValue

# pyuff leaves binary files open.
pytestmark = [
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]
RATE = 25600.0


def signal(values, rate=RATE, start=0.0, units="m/s2", name="acceleration"):
    """Return samples as a signal."""
    time = start + np.arange(len(values)) / rate
    return xr.DataArray(values, {"time": time}, ("time",), name, {"units": units})


def noise(count=500, seed=0):
    return np.random.default_rng(seed).standard_normal(count)


def written(path, text, encoding="utf-8"):
    path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
    return path


# What is written is read back.


@pytest.mark.parametrize(("ending", "error"), [(".csv", 0.0), (".uff", 1e-12), (".unv", 1e-12), (".wav", 2.0**-23)])
@pytest.mark.parametrize("rate", [25600.0, 32000.0, 51200.0])
@pytest.mark.parametrize("start", [0.0, -0.25, 12.5])
def test_a_signal_is_read_back(tmp_path, ending, error, rate, start):
    given = signal(noise(), rate, start)
    st.write_signal(tmp_path / f"a{ending}", given, full_scale=4.0)
    back = st.read_signal(tmp_path / f"a{ending}")
    assert back.dims == ("time",)
    assert back.attrs["units"] == "m/s2"
    assert back.name == ("channel 1" if ending == ".wav" else "acceleration")
    assert np.abs(back.values - given.values).max() <= error * 4.0
    np.testing.assert_allclose(back.time, given.time, rtol=0.0, atol=1e-9)


def test_flac_is_read_back_and_by_another_reader(tmp_path):
    st.write_signal(tmp_path / "a.flac", signal(noise(), units="Pa"), full_scale=4.0)
    assert st.read_signal(tmp_path / "a.flac").attrs["units"] == "Pa"
    samples, rate = soundfile.read(tmp_path / "a.flac")
    assert rate == RATE
    assert np.abs(4.0 * samples - noise()).max() <= 2.0**-21
    assert soundfile.info(tmp_path / "a.flac").format == "FLAC"
    assert st.read_wav(tmp_path / "a.flac").attrs["full_scale"] == 4.0


@pytest.mark.skipif("MP3" not in soundfile.available_formats(), reason="libsndfile without MP3")
def test_mp3_keeps_the_level_of_a_tone(tmp_path):
    time = np.arange(48000) / 48e3
    st.write_signal(tmp_path / "a.mp3", signal(np.sin(2e3 * np.pi * time), 48e3, units="Pa"))
    back = st.read_signal(tmp_path / "a.mp3")
    assert back.sizes["time"] == 48000
    middle = back.values[12000:36000]
    assert np.sqrt(np.mean(middle**2)) == pytest.approx(np.sqrt(0.5), rel=0.06)
    with pytest.raises(ValueError, match=r"^signal must be sampled at one of .* Hz, got 25600 Hz$"):
        st.write_signal(tmp_path / "a.mp3", signal(noise()))


def test_several_signals_are_read_back_with_their_units(tmp_path):
    given = xr.Dataset({"pad": signal(noise()), "load": signal(noise(seed=1), units="N", name="load")})
    for name in ("a.csv", "a.uff"):
        st.write_signal(tmp_path / name, given)
        back = st.read_signals(tmp_path / name)
        assert {str(name): one.attrs["units"] for name, one in back.items()} == {"pad": "m/s2", "load": "N"}
        for word in given:
            np.testing.assert_allclose(back[word], given[word], atol=1e-11)
            np.testing.assert_allclose(st.read_signal(tmp_path / name, word), given[word], atol=1e-11)
        with pytest.raises(ValueError, match=r"^'.*': channel must be chosen from 'pad', 'load', got none$"):
            st.read_signal(tmp_path / name)
        with pytest.raises(ValueError, match=r"^channel must be one of those of '.*': 'pad', 'load', got 'disc'$"):
            st.read_signals(tmp_path / name, ["disc"])


def test_records_exported_as_tables_are_read(tmp_path):
    run = st.load_scenario("belt").simulate(duration=0.5)
    st.export(run, tmp_path / "a.csv")
    back = st.read_signals(tmp_path / "a.csv")
    assert back["normal_force"].attrs["units"] == "N"
    np.testing.assert_array_equal(back["normal_force"], run["normal_force"])
    np.testing.assert_allclose(back.time, run.time, rtol=0.0, atol=1e-12)


# Universal files of another program.


def by_pyuff(path, values, times, *, even, binary=0, double=True, **words):
    pyuff = pytest.importorskip("pyuff")
    zeros = {"rsp_node": 7, "rsp_dir": -3, "ref_node": 0, "ref_dir": 0, "orddenom_spec_data_type": 0}
    axes = {"abscissa_spec_data_type": 17, "abscissa_axis_units_lab": "s", "ordinate_spec_data_type": 12}
    dataset = {"type": 58, "func_type": 1, "data": values, "x": times, "abscissa_spacing": int(even), "binary": binary}
    form = {} if double else {"ord_data_type": 2}
    pyuff.UFF(str(path)).write_sets(zeros | axes | dataset | form | words, "add", force_double=double)


@pytest.mark.parametrize("count", [2, 3, 5, 100, 101])
@pytest.mark.parametrize(("even", "binary", "double"), [(1, 0, 1), (0, 0, 1), (1, 0, 0), (0, 0, 0), (1, 1, 1)])
def test_what_pyuff_writes_is_read(tmp_path, count, even, binary, double):
    values, times = noise(count, count), 0.5 + np.arange(count) / 1000.0
    by_pyuff(
        tmp_path / "a.uff",
        values,
        times,
        even=even,
        binary=binary,
        double=bool(double),
        id1="disc",
        ordinate_axis_units_lab="g",
    )
    back = st.read_signal(tmp_path / "a.uff")
    assert (back.name, back.attrs["units"]) == ("disc", "g")
    np.testing.assert_allclose(back, values, rtol=1e-11 if double else 1e-5)
    np.testing.assert_allclose(back.time, times, atol=1e-9)


def test_no_binary_dataset_is_lost_among_several(tmp_path):
    for node in range(1, 6):
        by_pyuff(tmp_path / "a.uff", noise(seed=node), np.arange(500) / 1e3, even=1, binary=1, rsp_node=node)
    back = st.read_signals(tmp_path / "a.uff")
    assert list(back) == [f"{node} -Z" for node in range(1, 6)]
    for node, one in enumerate(back.values(), 1):
        np.testing.assert_array_equal(one, noise(seed=node))


def test_pyuff_reads_what_is_written(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    st.write_signal(tmp_path / "a.uff", signal(noise(), start=0.5))
    found = pyuff.UFF(str(tmp_path / "a.uff")).read_sets()
    np.testing.assert_allclose(found["data"], noise(), rtol=1e-11)
    np.testing.assert_allclose(found["x"], 0.5 + np.arange(500) / RATE, atol=1e-9)
    assert (found["id1"], found["ordinate_axis_units_lab"], found["func_type"]) == ("acceleration", "m/s2", 1)


def test_channels_without_different_titles_are_named_by_their_places(tmp_path):
    for direction, node in ((3, 7), (-1, 12)):
        by_pyuff(tmp_path / "a.uff", noise(), np.arange(500) / 1e3, even=True, rsp_dir=direction, rsp_node=node)
    assert list(st.read_signals(tmp_path / "a.uff")) == ["7 +Z", "12 -X"]
    assert st.read_signal(tmp_path / "a.uff", "12 -X").attrs["units"] == "unknown"


def test_units_of_the_file_become_si_where_the_axis_has_no_label(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    unit = {
        "type": 164,
        "units_code": 5,
        "units_description": "mm",
        "temp_mode": 1,
        "length": 1000.0,
        "force": 1000.0,
        "temp": 1.0,
        "temp_offset": 273.15,
    }
    pyuff.UFF(str(tmp_path / "a.uff")).write_sets(unit, "add")
    by_pyuff(tmp_path / "a.uff", noise(), np.arange(500) / 1e3, even=True)
    back = st.read_signal(tmp_path / "a.uff")
    assert back.attrs["units"] == "m/s2"
    np.testing.assert_allclose(back, noise() / 1000.0, rtol=1e-10)


def test_frequency_response_functions_are_left_out(tmp_path):
    values = noise(50) + 1j * noise(50, 1)
    by_pyuff(tmp_path / "a.uff", values, np.arange(50.0), even=True, func_type=4, abscissa_spec_data_type=18)
    with pytest.raises(
        ValueError, match=r"^path must have a time response, .*, got frequency response function in '.*a.uff'$"
    ):
        st.read_signal(tmp_path / "a.uff")
    by_pyuff(tmp_path / "a.uff", noise(), np.arange(500) / 1e3, even=True)
    assert st.read_signal(tmp_path / "a.uff").size == 500


def uff_text(tmp_path):
    st.write_signal(tmp_path / "good.uff", signal(noise(41)))
    return (tmp_path / "good.uff").read_text().splitlines(keepends=True)


def test_numbers_that_touch_are_read_by_their_columns(tmp_path):
    lines = uff_text(tmp_path)
    head = [*lines[:8], lines[8].replace("         4", "         2", 1), *lines[9:13]]
    body = "".join(f"{-abs(value):13.6E}" + "\n" * (k % 6 == 5) for k, value in enumerate(noise(41)))
    found = st.read_signal(written(tmp_path / "b.uff", "".join([*head, body, "\n    -1\n"])))
    np.testing.assert_allclose(found, -np.abs(noise(41)), rtol=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda x: [*x[:20], *x[23:]], r"line 22: the dataset must have 41 numbers, got 29"),
        (lambda x: x[:18], r"line 18: the file is cut off"),
        (lambda x: [*x[:15], x[15].replace(x[15][:20], "NaN".rjust(20)), *x[16:]], r"line 16: numbers must be finite"),
        (
            lambda x: [*x[:15], "*" * 20 + x[15][20:], *x[16:]],
            r"line 16: a number must be in columns 1 to 20, got '\*+'",
        ),
        (lambda x: [*x[:15], " " * 20 + x[15][20:], *x[16:]], r"line 16: a number must be in columns 1 to 20, got ''"),
        (lambda x: [*x[:20], x[20], *x[20:]], r"line 26: the dataset must have 41 numbers, got 45"),
        (lambda x: [*x[:9], x[9].replace(" s ", " Hz"), *x[10:]], r"line 10: times must have a unit of time, got 'Hz'"),
        (lambda x: ["hello\n"], r"path must have a time response, dataset 58, got no dataset in '.*a.uff'"),
        (lambda x: [*x[:8], "         9" + x[8][10:], *x[9:]], r"line 9: the type of data must be 2, 4, 5 or 6"),
    ],
)
def test_bad_universal_files_are_named_with_their_line(tmp_path, change, message):
    path = written(tmp_path / "a.uff", "".join(change(uff_text(tmp_path))))
    with pytest.raises(ValueError, match=message) as found:
        st.read_signal(path)
    assert "\n" not in str(found.value)


def test_binary_data_may_look_like_the_end_of_a_dataset(tmp_path):
    end = struct.unpack("<d", b"\n    -1\n")[0]
    by_pyuff(tmp_path / "a.uff", np.array([1.0, end, 2.0]), np.arange(3) / 1e3, even=True, binary=1)
    assert list(st.read_signal(tmp_path / "a.uff").values) == [1.0, end, 2.0]
    content = (tmp_path / "a.uff").read_bytes()
    with pytest.raises(ValueError, match=r"b.uff, line 13: 24 bytes must follow, got 15: the file is cut off"):
        st.read_signal(written(tmp_path / "b.uff", content[:-16]))


# Tables.


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("columns", [1, 3])
def test_tables_of_pandas_are_read_to_the_last_digit(tmp_path, separator, columns):
    names = [f"force {k} [N]" for k in range(columns)]
    table = pandas.DataFrame(np.stack([noise(seed=k) for k in range(columns)], 1), columns=names)
    table.insert(0, "Time (ms)", np.arange(500) / RATE * 1e3)
    table.to_csv(tmp_path / "a.csv", sep=separator, index=False)
    back = st.read_signals(tmp_path / "a.csv")
    assert list(back) == [f"force {k}" for k in range(columns)]
    for k, one in enumerate(back.values()):
        np.testing.assert_array_equal(one, noise(seed=k))
        assert one.attrs["units"] == "N"
    np.testing.assert_allclose(back.time, np.arange(500) / RATE, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("form", ["%.6f", "%.8e", "%.5e", "%g"])
def test_times_with_few_digits_are_on_an_even_grid(tmp_path, form):
    table = np.stack([np.arange(4000) / 10e3, noise(4000)], axis=1)
    np.savetxt(tmp_path / "a.txt", table, fmt=(form, "%.17g"), header="time [s] force [N]", comments="")
    back = st.read_signal(tmp_path / "a.txt")
    assert back.name == "force"
    np.testing.assert_allclose(back.time, table[:, 0], rtol=0.0, atol=1e-9)


def test_headings_may_have_lines_before_them_and_units_below_them(tmp_path):
    text = "Rig 4, operator A\nDate: 3 May\n\nt;F;x\n[s];[kN];\n0.0;1;2\n0.1;3;4\n0.2;5;6\n"
    back = st.read_signals(written(tmp_path / "a.csv", text))
    assert [(str(name), one.attrs["units"]) for name, one in back.items()] == [("F", "kN"), ("x", "unknown")]


def test_times_without_a_unit_get_it_from_the_user(tmp_path):
    path = written(tmp_path / "a.csv", "Time,F [N]\n0,1\n1,2\n2,3\n")
    back = st.read_signal(path, units={"time": "ms"})
    np.testing.assert_allclose(back.time, [0.0, 1e-3, 2e-3], atol=1e-15)
    assert back.attrs["units"] == "N"


def test_units_in_latin_1_and_decimal_commas_are_read(tmp_path):
    path = written(tmp_path / "a.csv", "t [s];w [µm/s²]\n0,0;1,5\n0,1;2,5\n0,2;3,5\n", "latin-1")
    back = st.read_signal(path, decimal=",")
    assert back.attrs["units"] == "µm/s2"
    assert list(back.values) == [1.5, 2.5, 3.5]
    with pytest.raises(ValueError, match=r"line 2: decimal must be ',' for its numbers, got '0,0'$"):
        st.read_signal(path)


def test_a_table_without_times_needs_a_rate(tmp_path):
    path = written(tmp_path / "a.csv", "1.0\n2.0\n4.0\n")
    with pytest.raises(
        ValueError, match=r": sample_rate must be given .* without a column named time, got 'column 1'$"
    ):
        st.read_signal(path)
    back = st.read_signal(path, sample_rate=25.6e3, units="N")
    assert back.attrs["units"] == "N"
    assert float(back.time[2]) == pytest.approx(2.0 / 25.6e3, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "t [s],F [N]\n0.0,1\n0.1,2\n0.3,3\n0.4,3\n0.5,3\n",
            r"line 4: times must be evenly spaced by 0.1 s, got a step of 0.2 s$",
        ),
        ("t [s],F [N]\n0.0,1\n0.1,2\n0.1,3\n", r"line 4: times must increase$"),
        ("t [s],F [N]\n0.0,1\n0.1,\n0.2,3\n", r"line 3: 'F' .* got a missing value$"),
        ("t [s],F [N]\n0.0,1\n\n# pause\n0.1,NaN\n0.2,3\n", r"line 5: 'F' .* got a missing value$"),
        ("t [s],F [N]\n0.0,1\n0.1,inf\n", r"line 3: 'F' must be a finite number, got 'inf'$"),
        ("t [s],F [N]\n0.0,1\n0.1,high\n", r"line 3: 'F' must be a finite number, got 'high'$"),
        ("t [s],F [N]\n0.0,1\n0.1,2,3\n", r"line 3: columns must be 2, as in line 2, got 3$"),
        ("t [s],F [N]\n0.0,1\n0.1\n", r"line 3: columns must be 2, as in line 2, got 1$"),
        ("t,F\n0.0,1\n0.1,2\n", r": t must have a unit of time, got 'unknown'; state it as t \[s\], or in units$"),
        ("t [Hz],F\n0.0,1\n0.1,2\n", r": t must have a unit of time, got 'Hz'$"),
        ("t [s],F,F\n0.0,1,2\n0.1,2,3\n", r"line 1: header must have different names, got 'F' twice$"),
        ("t [s],F,x\n0.0,1\n0.1,2\n", r": header must have a name for each column, got 3 in line 1 over 2 columns$"),
        ("t [s],F\n0.0,1\n", r": table must have at least 2 lines of numbers, got 1$"),
        ("t [s]\n0.0\n0.1\n", r": table must have a column beside time, got none$"),
        ("nothing\n", r": table must have lines of numbers, got none$"),
        ("", r": table must have lines of numbers, got none$"),
        (b"\0\1\2", r"^path must be a text file of columns, got a binary file$"),
        ("t [s],F\n0.0000,1\n0.0001,2\n0.0001,2\n0.0002,3\n", r"line 4: times must increase$"),
    ],
)
def test_bad_tables_are_named_with_their_line(tmp_path, text, message):
    with pytest.raises(ValueError, match=message) as found:
        st.read_signals(written(tmp_path / "a.csv", text))
    assert "\n" not in str(found.value)


def test_a_stated_rate_must_be_that_of_the_times(tmp_path):
    path = written(tmp_path / "a.csv", "t [s],F [N]\n0.0,1\n0.1,2\n0.2,3\n")
    assert st.read_signal(path, sample_rate=10.0).size == 3
    with pytest.raises(ValueError, match=r"^sample_rate must be that of .*a.csv, 10 Hz, got 20\.0$"):
        st.read_signal(path, sample_rate=20.0)


# Units and calibration.


def test_a_sound_without_calibration_is_relative_and_has_no_level(tmp_path):
    soundfile.write(tmp_path / "a.wav", 0.1 * noise(48000), 48000, subtype="FLOAT")
    relative = st.read_signal(tmp_path / "a.wav")
    assert relative.attrs["units"] == "FS"
    for measure in (st.equivalent_level, st.sound_level, st.third_octave_levels, st.loudness):
        with pytest.raises(
            ValueError, match=r"^pressure must be in Pa, got 'FS', relative to full scale: .* calibration"
        ):
            measure(relative)
    known = st.read_signal(tmp_path / "a.wav", calibration=20.0, units="Pa")
    np.testing.assert_allclose(known, 20.0 * relative)
    assert float(st.equivalent_level(known)) == pytest.approx(20.0 * np.log10(2.0 / 20e-6), abs=0.1)
    shaken = st.read_signal(tmp_path / "a.wav", calibration=40.0, units="m/s^2")
    assert shaken.attrs["units"] == "m/s2"
    with pytest.raises(ValueError, match=r"^pressure must be in Pa, got 'm/s2'$"):
        st.equivalent_level(shaken)


def channel(path, units):
    """Write a channel from -2 to 2 in some units."""
    path.write_text(f"time [s],x [{units}]\n" + "".join(f"{k / 10},{k - 2}\n" for k in range(5)))
    return path


@pytest.mark.parametrize(
    ("units", "sensitivity", "wanted", "factor", "result"),
    [
        ("V", "100 mV/g", None, 10.0, "g"),
        ("V", "100 mV/g", "m/s2", 98.0665, "m/s2"),
        ("mV", "10.2 mV/(m/s^2)", None, 1.0 / 10.2, "m/s2"),
        ("V", "50 mV/Pa", "Pa", 20.0, "Pa"),
        ("V", "2.5e-2 V/kN", "N", 40e3, "N"),
        ("nC", "-4 pC/N", None, -250.0, "N"),
    ],
)
def test_sensitivities_of_sensors_are_divided_by(tmp_path, units, sensitivity, wanted, factor, result):
    found = st.read_signal(channel(tmp_path / "a.csv", units), calibration=sensitivity, units=wanted)
    np.testing.assert_allclose(found, factor * np.arange(-2.0, 3.0), rtol=1e-12)
    assert found.attrs["units"] == result


@pytest.mark.parametrize(
    ("units", "wanted", "factor"),
    [("g", "m/s2", 9.80665), ("mm/s", "m/s", 1e-3), ("kN", "N", 1e3), ("bar", "kPa", 100.0), ("µm", "mm", 1e-3)],
)
def test_units_of_the_same_quantity_are_converted(tmp_path, units, wanted, factor):
    found = st.read_signal(channel(tmp_path / "a.csv", units), units=wanted)
    np.testing.assert_allclose(found, factor * np.arange(-2.0, 3.0), rtol=1e-12)
    assert found.attrs["units"] == wanted


def test_doubtful_and_wrong_calibrations_are_told(tmp_path):
    path = channel(tmp_path / "a.csv", "g")
    with pytest.warns(DoubtfulValue, match=r"^calibration of 'x' is 0.102, but 1 g is 9.80665 m/s2; leave it out"):
        found = st.read_signal(path, calibration=0.102, units="m/s2")
    np.testing.assert_allclose(found, 0.102 * np.arange(-2.0, 3.0))
    with pytest.warns(DoubtfulValue, match=r"turns 'x', an acceleration in g, into a pressure in Pa$"):
        st.read_signal(path, calibration=2.0, units="Pa")
    # Neither the conversion itself nor the output of a sensor is doubtful.
    st.read_signal(path, calibration=9.81, units="m/s2")
    st.read_signal(channel(tmp_path / "b.csv", "V"), calibration=10.0, units="Pa")
    for given in ("100", "100 g/mV", "100 mV/mA", "1.2.3 mV/g", "10,2 mV/g", "mV/g"):
        with pytest.raises(ValueError, match=r"^calibration must be a number, or a sensitivity such as '100 mV/g'"):
            st.read_signal(tmp_path / "b.csv", calibration=given)
    with pytest.raises(ValueError, match=r"^calibration must be a number for 'x', whose units are g: a sensitivity in"):
        st.read_signal(path, calibration="100 mV/g")
    with pytest.raises(ValueError, match=r"^units must be those of g, as in the calibration, got 'Pa'$"):
        st.read_signal(tmp_path / "b.csv", calibration="100 mV/g", units="Pa")
    with pytest.raises(ValueError, match=r"^calibration must be finite, got inf"):
        st.read_signal(tmp_path / "b.csv", calibration="1e999 mV/g")
    with pytest.raises(ValueError, match=r"^calibration must differ from 0, got '0 mV/g'$"):
        st.read_signal(tmp_path / "b.csv", calibration="0 mV/g")


def test_a_calibration_needs_units_and_units_a_calibration(tmp_path):
    path = written(tmp_path / "a.csv", "t [s],u [V],F [N]\n0.0,1,1\n0.1,2,2\n0.2,3,3\n")
    with pytest.raises(ValueError, match=r"^units must be given with the calibration of 'u', got none$"):
        st.read_signal(path, "u", calibration=10.0)
    with pytest.raises(ValueError, match=r"^calibration must be given to turn 'V' into 'Pa', got none$"):
        st.read_signal(path, "u", units="Pa")
    with pytest.raises(ValueError, match=r"^calibration must differ from 0, got 0\.0$"):
        st.read_signal(path, "u", units="Pa", calibration=0.0)
    for given in ({"calibration": {"v": 2.0}}, {"units": {"v": "Pa"}}):
        with pytest.raises(ValueError, match=r"^(units|calibration) must be by names of channels, 'u', 'F', got 'v'$"):
            st.read_signals(path, **given)
    with pytest.raises(
        ValueError, match=r"^calibration must be left out for 'F', which the file has in N: .* got 2\.0$"
    ):
        st.read_signal(path, "F", units="N", calibration=2.0)
    one = st.read_signal(path, "F", calibration={"u": 10.0}, units={"u": "Pa"})
    assert one.attrs["units"] == "N"
    both = st.read_signals(path, calibration={"u": 10.0}, units={"u": "Pa"})
    assert [one.attrs["units"] for one in both.values()] == ["Pa", "N"]
    assert list(both["u"].values) == [10.0, 20.0, 30.0]


def test_other_files_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"^path must end as one of sounds .wav .*, got 'a.pdf'$"):
        st.read_signal("a.pdf")
    with pytest.raises(FileNotFoundError, match=r"^cannot read 'missing.csv': no such file or directory$"):
        st.read_signal("missing.csv")
    with pytest.raises(ValueError, match=r"^path must be a sound file, got '.*a.wav': "):
        st.read_signal(written(tmp_path / "a.wav", "no sound"))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (lambda: signal(noise() + np.nan), r"^signal must have finite numbers, got others in 'acceleration'$"),
        (lambda: signal(noise()).assign_coords(time=np.arange(500.0) ** 2), r"^signal must be evenly sampled"),
        (lambda: signal(noise()).rename(time="x"), r"^signal must be a signal over time, .*, got the dimensions x$"),
        (lambda: 3.0, r"^signal must be a signal over time, or signals by name, got 3\.0$"),
    ],
)
def test_other_signals_are_not_written(tmp_path, given, message):
    with pytest.raises(ValueError, match=message):
        st.write_signal(tmp_path / "a.csv", given())
    assert not list(tmp_path.iterdir())


def test_a_signal_is_never_clipped(tmp_path):
    with pytest.raises(
        ValueError,
        match=r"^full_scale must be at least 2 Pa|^full_scale must be at least 2\.0\d* Pa for a peak of 2 Pa",
    ):
        st.write_signal(tmp_path / "a.wav", signal(np.array([2.0, 0.0]), units="Pa"), full_scale=1.0)


# Files of measurement systems.


def test_tdms_files_of_another_writer_are_read(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    said = {"wf_increment": 1.0 / RATE, "wf_start_offset": 0.5, "unit_string": "m/s^2"}
    with nptdms.TdmsWriter(str(tmp_path / "a.tdms")) as file:
        file.write_segment([nptdms.ChannelObject("rig", "pad", noise(), said)])
    back = st.read_signal(tmp_path / "a.tdms")
    assert (back.name, back.attrs["units"], float(back.time[0])) == ("pad", "m/s2", 0.5)
    np.testing.assert_array_equal(back, noise())
    np.testing.assert_allclose(back.time, 0.5 + np.arange(500) / RATE, atol=1e-12)
    with pytest.raises(ValueError, match=r"^path must be a TDMS file, got '.*b.tdms': "):
        st.read_signal(written(tmp_path / "b.tdms", "no measurement"))


def test_mdf_files_of_another_writer_are_read(tmp_path):
    asammdf = pytest.importorskip("asammdf")
    times = np.arange(500) / RATE
    one = asammdf.Signal(noise(), times, unit="m/s^2", name="pad")
    slow = asammdf.Signal(np.arange(5.0), np.arange(5) * 0.1, unit="rpm", name="speed")
    with asammdf.MDF(version="4.10") as file:
        file.append([one])
        file.append([asammdf.Signal(2.0 * noise(), times, unit="m/s^2", name="pad")])
        file.append([slow])
        file.save(tmp_path / "a.mf4")
    back = st.read_signal(tmp_path / "a.mf4", "pad")
    assert back.attrs["units"] == "m/s2"
    np.testing.assert_array_equal(back, noise())
    np.testing.assert_allclose(back.time, times, atol=1e-9)
    again = st.read_signals(tmp_path / "a.mf4", ["pad", "pad (2)"])
    np.testing.assert_array_equal(again["pad (2)"], 2.0 * noise())
    with pytest.raises(ValueError, match=r"channels must have the same times, got 'pad' with 500 at 25600 Hz"):
        st.read_signals(tmp_path / "a.mf4")
    with pytest.raises(ValueError, match=r"^path must be an MDF file, got '.*b.mf4': "):
        st.read_signal(written(tmp_path / "b.mf4", "no measurement"))
