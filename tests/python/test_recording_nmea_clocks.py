"""Logs with several clocks, with times beside their sentences, and with zeros left out."""

import datetime
import math
import re
from functools import reduce
from operator import xor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wakeline.recording import RecordingError, read_nmea

DAY_S = 86400
NOON_S = 1786795200.0  # 2026-08-15 12:00:00 UTC
KNOT_MPS = 1852.0 / 3600.0
SECONDS = 90


def sentence(body):
    return f"${body}*{reduce(xor, body.encode(), 0):02X}"


def clock(time_s, decimals=2):
    second = round(time_s % DAY_S, decimals)
    width = 3 + decimals if decimals else 2
    return (
        f"{int(second // 3600):02d}{int(second // 60 % 60):02d}{second % 60:0{width}.{decimals}f}"
    )


def date(time_s):
    return datetime.datetime.fromtimestamp(time_s, datetime.timezone.utc).strftime("%d%m%y")


def place(t):
    """Where the ship is, 6 kn on 060 from 54° 30' N, 10° 30' E."""
    way_m = 6.0 * KNOT_MPS * t
    north_min = 30.0 + way_m * 0.5 / 1852.0
    east_min = 30.0 + way_m * math.sin(math.radians(60)) / (1852.0 * math.cos(math.radians(54.5)))
    return f"54{north_min:07.4f},N,010{east_min:07.4f},E"


def rmc(t, talker="GP", *, at=None, dated=True, offset_s=0.0, status="A", where=None, day_s=0.0):
    """The RMC of second t, its clock ahead by `offset_s`."""
    time_s = NOON_S + (t if at is None else at) + offset_s
    where = place(t) if where is None else where
    day = date(time_s + day_s) if dated else ""
    return sentence(f"{talker}RMC,{clock(time_s)},{status},{where},6.00,60.0,{day},,,A")


def gll(t, talker="GP", *, offset_s=0.0):
    return sentence(f"{talker}GLL,{place(t)},{clock(NOON_S + t + offset_s)},A,A")


def gga(t, talker="GP", *, offset_s=0.0):
    return sentence(f"{talker}GGA,{clock(NOON_S + t + offset_s)},{place(t)},1,08,0.9,1.0,M,,M,,")


def zda(t, talker="II", *, offset_s=0.0):
    time_s = NOON_S + t + offset_s
    day = datetime.datetime.fromtimestamp(time_s, datetime.timezone.utc).strftime("%d,%m,%Y")
    return sentence(f"{talker}ZDA,{clock(time_s)},{day},00,00")


@pytest.fixture
def log(tmp_path):
    def read(lines, **options):
        path = tmp_path / "own.nmea"
        path.write_text("\n".join([*lines, ""]), encoding="latin-1")
        return read_nmea(path, **options)

    return read


def both(*sources):
    """Lines of sources, turn by turn."""
    return [line for lines in zip(*sources, strict=True) for line in lines]


def check_voyage(read, seconds=SECONDS, start_s=NOON_S):
    """The fixes are those of the ship, at its times."""
    fixes = read.fixes.sound()
    np.testing.assert_allclose(fixes.time_s, start_s + np.arange(seconds), atol=1e-3)
    for t in (0, seconds - 1):
        degrees, minutes = re.match(r"(\d\d)([\d.]+)", place(t)).groups()
        assert fixes.latitude_deg[t] == pytest.approx(int(degrees) + float(minutes) / 60, abs=1e-6)
    assert len(read.set_back_lines) == 0
    assert len(read.parts()) == 1


# ------------------------------------------------------------------ whose clock counts

DEAD = {
    "at 0/0": "{}RMC,000000.00,A,0000.000,N,00000.000,E,0.0,0.0,050505,0.0,E",
    "invalid": "{}RMC,000000.00,V,,,,,,,,,,N",
    "old date": "{}RMC,000000.00,V,,,,,,,060180,,,N",
    "invalid GGA": "{}GGA,000000.00,,,,,0,00,,,M,,M,,",
    "invalid GLL": "{}GLL,,,,,000000.00,V,N",
    "ZDA": "{}ZDA,000000.00,06,01,1980,00,00",
}


@pytest.mark.parametrize("dead", DEAD)
@pytest.mark.parametrize("talker", ["GP", "GN"])
@pytest.mark.parametrize("order", [(0, 1), (1, 0), (0, 0, 0, 1)])
@pytest.mark.parametrize("seconds", [4, SECONDS])
def test_a_receiver_without_satellites_does_not_time_the_log(log, dead, talker, order, seconds):
    dead = [sentence(DEAD[dead].format(talker))] * seconds
    good = [rmc(t) for t in range(seconds)]
    check_voyage(log(both(*((dead, good)[k] for k in order))), seconds)


@pytest.mark.parametrize("status", ["A", "V"])
@pytest.mark.parametrize("start_s", [-NOON_S % DAY_S, 7.0 - DAY_S / 2, 1234.5])
def test_nor_does_one_whose_clock_runs(log, status, start_s):
    dead = [
        rmc(t, "GN", offset_s=start_s, status=status, where="0000.0,N,00000.0,E", day_s=-4e8)
        for t in range(SECONDS)
    ]
    read = log(both(dead, [rmc(t) for t in range(SECONDS)]))
    check_voyage(read)


def test_the_conflict_is_reported_with_both_times(log):
    dead = [sentence(DEAD["at 0/0"].format("GN"))] * SECONDS
    notes = log(both(dead, list(map(rmc, range(SECONDS))))).notes
    (note,) = [n for n in notes if "12:00:00" in n and "problem" not in n]
    assert "00:00:00" in note
    assert "GNRMC" in note
    assert "GPRMC" in note


LOCAL = {"GLL": gll, "GGA": gga, "ZDA": zda, "RMC": lambda t, **more: rmc(t, dated=False, **more)}


@pytest.mark.parametrize("kind", LOCAL)
@pytest.mark.parametrize("hours", [-11, -3.5, -1, 1, 2, 5.75, 10, 13])
@pytest.mark.parametrize("first", [True, False])
def test_local_time_beside_utc_is_corrected(log, kind, hours, first):
    local = [LOCAL[kind](t, talker="SK", offset_s=3600.0 * hours) for t in range(SECONDS)]
    good = [rmc(t) for t in range(SECONDS)]
    read = log(both(local, good) if first else both(good, local))
    check_voyage(read)
    assert any("local time" in note for note in read.notes)


def test_a_date_in_local_time_is_that_of_utc(log):
    """14 hours ahead it is tomorrow there."""
    lines = both(
        [zda(t, offset_s=14 * 3600.0) for t in range(SECONDS)], [gga(t) for t in range(SECONDS)]
    )
    offset_s = 14 * 3600.0 - DAY_S  # which of the two days cannot be known from times of day
    fixes = log(lines).fixes
    assert fixes.time_s[0] - NOON_S in (0.0, 14 * 3600.0 - offset_s)


@given(
    lag=st.integers(1, 30),
    missing=st.sets(st.integers(10, 60), max_size=5),
    dated=st.booleans(),
    repeater=st.sampled_from(["II", "GP"]),
)
@settings(max_examples=30)
def test_a_late_repeater_does_not_set_the_clock_back(
    tmp_path_factory, lag, missing, dated, repeater
):
    """What the first source lacks is taken from the one that repeats it."""
    lines = []
    for t in range(120):
        lines += [] if t in missing else [rmc(t)]
        lines += [rmc(t - lag, repeater, dated=dated)] if t >= lag else []
    path = tmp_path_factory.getbasetemp() / "late.nmea"
    path.write_text("\n".join(lines))
    read = read_nmea(path)
    times_s = read.fixes.sound().time_s - NOON_S
    assert set(range(120)) - missing <= set(times_s.tolist())
    assert (np.diff(times_s) > 0).all()
    assert len(read.set_back_lines) == 0


@given(late=st.lists(st.sampled_from([0, 0, 1, 2]), min_size=60, max_size=60))
@settings(max_examples=30)
def test_a_step_back_within_reorder_s_is_never_a_clock_set_back(tmp_path_factory, late):
    order = sorted(range(60), key=lambda t: t + late[t] + 0.5 * (late[t] > 0))
    path = tmp_path_factory.getbasetemp() / "jitter.nmea"
    path.write_text("\n".join(rmc(t, "GP" if t % 3 else "II") for t in order))
    check_voyage(read_nmea(path), 60)


@pytest.mark.parametrize("last", [-4, -60, -3600])
def test_a_time_before_the_last_at_the_end_of_the_log_is_wrong(log, last):
    read = log([*map(rmc, range(SECONDS)), rmc(SECONDS, at=SECONDS + last)])
    check_voyage(read)
    assert read.report.problems["time"] == 1


def test_wrong_times_at_the_start_are_wrong(log):
    read = log([rmc(0, at=7000), rmc(0, at=7001), *map(rmc, range(SECONDS))])
    check_voyage(read)
    assert read.report.problems["time"] == 2


def test_the_speed_of_a_receiver_that_is_left_out_is_left_out(log):
    dead = [sentence(DEAD["invalid"].format("GN"))] * SECONDS
    still = [sentence("GNVTG,0.0,T,,M,0.0,N,0.0,K,A")] * SECONDS
    speed = [sentence("GPVTG,60.0,T,,M,6.0,N,11.1,K,A")] * SECONDS
    read = log(both(dead, still, [gga(t) for t in range(SECONDS)], speed))
    check = read.ground.speed_mps[read.ground.valid]
    np.testing.assert_allclose(check, 6.0 * KNOT_MPS)


def test_stamps_in_utc_decide_between_clocks_that_are_else_alike(log):
    one = [f"{t + NOON_S:.1f} {gll(t, 'GP', offset_s=100.0)}" for t in range(SECONDS)]
    other = [f"{t + NOON_S:.1f} {gll(t, 'II')}" for t in range(SECONDS)]
    read = log(both(one, other), date=datetime.date(2026, 8, 15))
    check_voyage(read)


@pytest.mark.parametrize("dated", [True, False])
@pytest.mark.parametrize("start_s", [0, 3 * 3600, 16 * 3600])
def test_times_before_the_first_fix_that_do_not_lead_to_it_are_wrong(log, dated, start_s):
    waiting = [
        sentence(f"GPRMC,{clock(start_s + t)},V,,,,,,,{'060180' if dated else ''},,,N")
        for t in range(50)
    ]
    read = log([*waiting, *map(rmc, range(SECONDS))])
    check_voyage(read)
    assert read.report.problems["time"] == 50
    waiting = [sentence(f"GPRMC,{clock(NOON_S + t)},V,,,,,,,,,,N") for t in range(-50, 0)]
    assert log([*waiting, *map(rmc, range(SECONDS))]).report.problems == {}


def test_stamps_in_utc_show_local_time_and_give_the_date(log):
    local = [f"{NOON_S + t + 0.4:.1f} {gll(t, offset_s=7200.0)}" for t in range(SECONDS)]
    check_voyage(log(local))
    undated = [f"{NOON_S + t + 0.4:.1f} {gga(t)}" for t in range(SECONDS)]
    check_voyage(log(undated))


def test_one_of_two_clocks_that_stands_has_the_times_of_the_stamps(log):
    lines = both(standing(SECONDS), [gga(t + 0.5) for t in range(SECONDS)])
    lines = [f"{NOON_S + t / 2:.1f} {line}" for t, line in enumerate(lines)]
    read = log(lines)
    np.testing.assert_allclose(read.fixes.time_s, NOON_S + np.arange(2 * SECONDS) / 2)
    assert len(read.ground) == SECONDS


# ------------------------------------------------------------------ clocks that stand


def standing(seconds):
    return [sentence(f"IIRMC,171300,A,{place(t)},06.0,060,140826,,,A") for t in range(seconds)]


def stamped(lines, form="%Y-%m-%dT%H:%M:%S.168370+00:00\t"):
    return [
        datetime.datetime.fromtimestamp(NOON_S + t, datetime.timezone.utc).strftime(form) + line
        for t, line in enumerate(lines)
    ]


def test_a_clock_that_stands_is_replaced_by_the_stamps_or_named(log):
    read = log(stamped(standing(SECONDS)))
    check_voyage(read, start_s=NOON_S + 0.16837)
    assert any("17:13:00" in note and "stands" in note for note in read.notes)
    with pytest.raises(RecordingError, match="stands at 17:13:00"):
        log(standing(SECONDS))


def test_a_clock_that_stands_for_a_while(log):
    lines = [rmc(t, at=30 if 30 <= t < 60 else t) for t in range(SECONDS)]
    read = log(lines)
    assert any("stands at 12:00:30 (line 31 to 60)" in note for note in read.notes)
    check_voyage(log(stamped(lines)))


@pytest.mark.parametrize("step_s", [1, 2, 5])
@pytest.mark.parametrize("stamps", [True, False])
def test_a_minute_that_repeats_is_named(log, step_s, stamps):
    lines = [
        sentence(f"IIRMC,0802{t % 60:02d},A,{place(t)},06.0,060,150826,,,A")
        for t in range(0, 300, step_s)
    ]
    if stamps:
        lines = [f"{NOON_S + t * step_s:.0f} {line}" for t, line in enumerate(lines)]
    read = log(lines)
    assert any("08:02 repeats 4 times" in note for note in read.notes)
    assert np.diff(read.fixes.time_s) == pytest.approx(step_s)
    assert len(read.set_back_lines) == 0
    assert read.fixes.time_s[0] - NOON_S == (0 if stamps else 8 * 3600 + 120 - 43200)


# ------------------------------------------------------------------ times beside the sentence

UNTIMED = [sentence(f"GPGLL,{place(t)},,A,A") for t in range(SECONDS)]


def tag(t):
    block = f"s:kplex,c:{NOON_S + t:.0f}"
    return f"\\{block}*{reduce(xor, block.encode(), 0):02X}\\"


def tag_ms(t):
    block = f"c:{1000 * (NOON_S + t):.0f},s:r"
    return f"\\{block}*{reduce(xor, block.encode(), 0):02X}\\"


def utc(form):
    return lambda t: datetime.datetime.fromtimestamp(NOON_S + t, datetime.timezone.utc).strftime(
        form
    )


BEFORE = {
    "tag": tag,
    "tag in ms": tag_ms,
    "ISO": utc("%Y-%m-%dT%H:%M:%SZ "),
    "ISO with zone": lambda t: utc("%Y-%m-%d %H:%M:%S+02:00,")(t + 7200),
    "underscore": utc("%Y-%m-%d_%H:%M:%S "),
    "brackets": utc("[%Y/%m/%d %H:%M:%S.000] "),
    "columns": utc("GPGLL,%Y-%m-%d,%H:%M:%S,"),
    "day first": utc("%d/%m/%Y %H:%M:%S;"),
    "month first": utc("%m/%d/%Y %H:%M:%S;"),
    "compact": utc("%Y%m%dT%H%M%SZ "),
    "seconds": lambda t: f"{NOON_S + t:.3f},",
    "milliseconds": lambda t: f"{1000 * (NOON_S + t):.0f};N;",
    "microseconds": lambda t: f"{1e6 * (NOON_S + t):.0f} ",
}


@pytest.mark.parametrize("form", BEFORE)
def test_times_before_sentences_without_a_time(log, form):
    speed = sentence("IIVTG,60.0,T,,M,6.0,N,11.1,K,A")
    lines = [f"{BEFORE[form](t)}{s}" for t, fix in enumerate(UNTIMED) for s in (speed, fix)]
    read = log(lines)
    check_voyage(read)
    np.testing.assert_allclose(read.ground.time_s, NOON_S + np.arange(SECONDS))
    assert read.dated


def test_times_after_sentences_and_in_columns_of_a_recorder(log):
    check_voyage(log([f"{line},{NOON_S + t:.0f}" for t, line in enumerate(UNTIMED)]))
    table = ["time_s,sentence", *(f'{NOON_S + t},"{line}"' for t, line in enumerate(UNTIMED))]
    check_voyage(log(table))


def test_times_of_day_and_seconds_since_the_start_have_no_date(log):
    lines = [f"{utc('%H:%M:%S.000 ')(t)}{line}" for t, line in enumerate(UNTIMED)]
    read = log(lines)
    assert not read.dated
    np.testing.assert_allclose(read.fixes.time_s, 43200 + np.arange(SECONDS))
    check_voyage(log(lines, date=datetime.date(2026, 8, 15)))
    read = log([f"{t + 0.25:.3f} {line}" for t, line in enumerate(UNTIMED)])
    np.testing.assert_allclose(np.diff(read.fixes.time_s), 1.0)


def test_readings_without_a_time_are_placed_by_stamps(log):
    """Of a logger in local time whose lines come in bursts."""
    lines = []
    for t in range(0, SECONDS, 10):
        lines.append(f"{utc('%Y-%m-%d %H:%M:%S.500')(t + 7200)} {rmc(t)}")
        for k in (1, 2, 9):
            stamp = utc("%Y-%m-%d %H:%M:%S.500")(t + k + 7200)
            lines.append(f"{stamp} {sentence(f'HEHDT,{t + k}.0,T')}")
    read = log(lines)
    np.testing.assert_allclose(read.fixes.time_s, NOON_S + np.arange(0, SECONDS, 10))
    heading_deg = np.degrees(read.heading.heading_rad)
    np.testing.assert_allclose(read.heading.time_s - NOON_S, heading_deg, atol=1e-6)


def test_stamps_coarser_than_the_fixes_are_spread(log):
    fixes = [sentence(f"GPGLL,{place(t / 5)},,A,A") for t in range(5 * SECONDS)]
    read = log([f"{NOON_S + t // 5:.0f} {line}" for t, line in enumerate(fixes)])
    np.testing.assert_allclose(read.fixes.time_s, NOON_S + np.arange(5 * SECONDS) / 5)


# ------------------------------------------------------------------ dates


def test_the_date_given_overrides_the_log(log):
    early = [rmc(t, day_s=-7168.0 * DAY_S) for t in range(SECONDS)]
    read = log(early)
    assert read.fixes.time_s[0] == NOON_S - 7168 * DAY_S
    assert any("2006-12-30" in n and "2026-08-15" in n and "1024 weeks" in n for n in read.notes)
    read = log(early, date=datetime.date(2026, 8, 15))
    check_voyage(read)
    assert any("2006-12-30" in note and "2026-08-15" in note for note in read.notes)
    assert not any(
        "given" in n for n in log(map(rmc, range(9)), date=datetime.date(2026, 8, 15)).notes
    )


def test_a_date_given_is_that_of_the_first_sentence_over_midnight(log):
    lines = [rmc(t, at=t + 43200 - 40, day_s=-1e6 * 86.4) for t in range(SECONDS)]
    read = log(lines, date=datetime.date(2026, 8, 15))
    np.testing.assert_allclose(read.fixes.time_s, NOON_S + 43200 - 40 + np.arange(SECONDS))


@pytest.mark.parametrize("order", [1, -1])
def test_a_missed_rollover_is_corrected_by_another_source(log, order):
    early = [rmc(t, day_s=-7168.0 * DAY_S) for t in range(SECONDS)]
    check_voyage(log(both(*[early, [zda(t, "GP") for t in range(SECONDS)]][::order])))
    read = log(stamped(early))
    check_voyage(read)
    assert any("1024 weeks" in note for note in read.notes)


# ------------------------------------------------------------------ forms of numbers


def without_zeros(line):
    """The sentence with numbers as a program prints them that knows no widths."""
    fields = line[1:-3].split(",")
    fields = [re.sub(r"^0+(?=\d)", "", f) if re.fullmatch(r"[\d.]+", f) else f for f in fields]
    return sentence(",".join(fields))


@given(
    latitude=st.floats(0, 89.9),
    longitude=st.floats(0, 179.9),
    sides=st.tuples(st.sampled_from("NS"), st.sampled_from("EW")),
    start_s=st.integers(0, DAY_S - 3),
    decimals=st.sampled_from([0, 1, 2]),
    day=st.dates(datetime.date(2001, 1, 1), datetime.date(2029, 12, 31)),
)
@settings(max_examples=60)
def test_leading_zeros_may_be_missing(
    tmp_path_factory, latitude, longitude, sides, start_s, decimals, day
):
    def minutes(value, width):
        return f"{int(value):0{width}d}{value % 1 * 60:07.4f}"

    where = f"{minutes(latitude, 2)},{sides[0]},{minutes(longitude, 3)},{sides[1]}"
    full = []
    for t in range(start_s, start_s + 3):
        full.append(sentence(f"GPRMC,{clock(t, decimals)},A,{where},6.0,60.0,{day:%d%m%y},,,A"))
        full.append(sentence(f"GPGLL,{where},{clock(t, decimals)},A,A"))
        full.append(sentence(f"GPGGA,{clock(t, decimals)},{where},1,08,0.9,1.0,M,,M,,"))
    path = tmp_path_factory.getbasetemp() / "widths.nmea"
    read = []
    for lines in (full, map(without_zeros, full)):
        path.write_text("\n".join(lines))
        read.append(read_nmea(path))
    whole, short = read
    assert short.report.problems == {}
    np.testing.assert_array_equal(short.fixes.time_s, whole.fixes.time_s)
    np.testing.assert_array_equal(short.fixes.latitude_deg, whole.fixes.latitude_deg)
    np.testing.assert_array_equal(short.fixes.longitude_deg, whole.fixes.longitude_deg)


@pytest.mark.parametrize(
    ("where", "latitude_deg", "longitude_deg"),
    [
        ("5460.00,N,01030.00,E", 55.0, 10.5),
        ("5460.0000,S,00960.000,W", -55.0, -10.0),
        ("8960.00,N,17960.0,E", 90.0, 180.0),
        ("4425.8,N,159.4,W", 44.43, -1.99),
        ("5047.4,N,9.3,E", 50.79, 0.155),
        ("30.0,S,1030.0,E", -0.5, 10.5),
    ],
)
def test_minutes_of_60_carry_and_the_two_digits_before_the_point_are_minutes(
    log, where, latitude_deg, longitude_deg
):
    read = log([rmc(0, where=where)])
    assert read.report.problems == {}
    assert read.fixes.latitude_deg == pytest.approx([latitude_deg])
    assert read.fixes.longitude_deg == pytest.approx([longitude_deg])


@pytest.mark.parametrize(
    ("field", "variation_deg"),
    [("-5.7,E", -5.7), ("5.7,W", -5.7), ("+5.7,E", 5.7), ("-5.7,", -5.7), ("5.7,E", 5.7)],
)
def test_a_variation_may_have_a_sign(log, field, variation_deg):
    read = log([rmc(0), sentence(f"IIHDG,65.7,,,{field}"), rmc(1)])
    assert read.report.problems == {}
    assert np.degrees(read.heading.heading_rad) == pytest.approx([65.7 + variation_deg])


@pytest.mark.parametrize("field", ["-5.7,W", "5.7,", "-190,E"])
def test_a_variation_whose_side_is_not_clear_is_a_problem(log, field):
    read = log([rmc(0), sentence(f"IIHDG,65.7,,,{field}"), rmc(1)])
    assert read.report.problems.total() == 1
    assert np.isnan(read.compass.variation_rad).all()


def test_the_variation_given_overrides_the_log(log):
    fix = sentence(f"GPRMC,120000,A,{place(0)},6.0,60.0,150826,0.0,E,A")
    lines = [fix, sentence("HCHDM,72.0,M"), sentence("HCHDG,72.0,,,1.0,E")]
    read = log(lines, variation_deg=-12.0)
    assert np.degrees(read.heading.heading_rad) == pytest.approx([60.0, 60.0])
    assert any("-12.0°" in note and "+0.0°" in note for note in read.notes)
    assert not any("instead" in note for note in log(lines[:1], variation_deg=0.0).notes)
