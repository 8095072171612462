"""Codecs of radar networks beside those of others: pynmea2, libasterix, asterix_decoder,
aviconv-asterix, Wireshark, and a reader that follows OpenCPN's rules."""

import copy
import math
import pickle
import re

import numpy as np
import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from judges import by_asterix_decoder, by_aviconv, by_tshark

DAY = 86400.0
MILE = 1852.0
START = 20_000 * DAY  # a midnight
PLANE = wl.LocalPlane(latitude_rad=math.radians(63.4), longitude_rad=math.radians(10.4))


def tracks_at(time_s, count=12, seed=1):
    """Columns of tracks for a feed."""
    random = np.random.default_rng(seed)
    mean = np.column_stack(
        [
            random.uniform(-20e3, 20e3, count),
            random.uniform(-15, 15, count),
            random.uniform(-20e3, 20e3, count),
            random.uniform(-15, 15, count),
        ]
    )
    root = random.normal(0, 3, (count, 4, 4))
    return {
        "track_id": np.arange(count) + 1,
        "estimate_time_s": time_s - random.uniform(0, 2, count),
        "mean": mean,
        "covariance": root @ root.transpose(0, 2, 1),
        "coasting": np.arange(count) % 3 == 0,
        "turn_rate_rad_s": random.uniform(-0.02, 0.02, count),
        "age_s": random.uniform(0, 9, count),
        "name": [f"BOAT {k}" if k % 2 else "" for k in range(count)],
    }


def true_course_deg(columns):
    latitude, longitude = PLANE.place(columns["mean"][:, [0, 2]])
    course = PLANE.true_course_rad(
        np.arctan2(columns["mean"][:, 3], columns["mean"][:, 1]),
        latitude_rad=latitude,
        longitude_rad=longitude,
    )
    return np.degrees(latitude), np.degrees(longitude), np.degrees(course)


def rows_of(blocks):
    return [record for block in blocks for record in block]


def near(step):
    return {"rel": 0, "abs": 0.5001 * step}


# --------------------------------------------------------------------------- tracks as ASTERIX


@pytest.fixture(scope="module")
def cat062():
    columns = tracks_at(START + 86399.5)
    feed = wl.wire.Cat062Feed(PLANE, area=7, system=9, service=3, datagram_octets=256)
    return columns, feed.update(START + 86399.5, **columns)


@pytest.fixture(scope="module")
def cat010():
    columns = tracks_at(START + 4000.5)
    feed = wl.wire.Cat010Feed(PLANE, area=7, system=9, datagram_octets=256)
    return columns, feed.update(START + 4000.5, **columns)


def mode_of_movement(rate_rad_s):
    return 1 if rate_rad_s > math.radians(0.3) else 2 if rate_rad_s < -math.radians(0.3) else 0


def check_062(columns, seen):
    """Records as (time, latitude, longitude, x, y, vx, vy, number, name, coasting, first, trans,
    std x, std y, cov, std vx, std vy, age), None for what a judge does not say."""
    latitude, longitude, _ = true_course_deg(columns)
    assert len(seen) == len(columns["track_id"])
    for k, one in enumerate(seen):
        mean, covariance = columns["mean"][k], columns["covariance"][k]
        std = np.sqrt(np.diag(covariance))
        cross = math.copysign(math.sqrt(abs(covariance[0, 2])), covariance[0, 2])
        wanted = [
            (columns["estimate_time_s"][k] % DAY, 1 / 128),
            (latitude[k], 180 / 2**25),
            (longitude[k], 180 / 2**25),
            (mean[2], 0.5),
            (mean[0], 0.5),
            (mean[3], 0.25),
            (mean[1], 0.25),
            (k + 1, 0),
            (columns["name"][k], None),
            (int(columns["coasting"][k]), 0),
            (1, 0),
            (mode_of_movement(columns["turn_rate_rad_s"][k]), 0),
            (std[2], 0.5),
            (std[0], 0.5),
            (cross, 0.5),
            (std[3], 0.25),
            (std[1], 0.25),
            (columns["age_s"][k], 0.25),
        ]
        for place, (value, (expected, step)) in enumerate(zip(one, wanted, strict=True)):
            if value is None:
                continue
            if step is None:
                assert value == expected
            else:
                assert value == pytest.approx(expected, **near(step)), (k, place)


def test_category_062_as_asterix_decoder_reads_it(cat062):
    columns, datagrams = cat062
    seen = []
    for record in rows_of(by_asterix_decoder(datagrams)):
        assert record["category"] == 62
        assert record["I010"] == {"SAC": 7, "SIC": 9}
        assert record["I015"]["SID"] == 3
        accuracy = record["I500"]
        seen.append(
            (
                record["I070"]["ToT"],
                record["I105"]["Lat"],
                record["I105"]["Lon"],
                record["I100"]["X"],
                record["I100"]["Y"],
                record["I185"]["Vx"],
                record["I185"]["Vy"],
                record["I040"]["TrkN"],
                record.get("I245", {"TId": ""})["TId"].strip(),
                record["I080"].get("CST", 0),
                record["I080"]["TSB"],
                record["I200"]["TRANSA"],
                accuracy["APC"]["APC_X"],
                accuracy["APC"]["APC_Y"],
                accuracy["COV"]["COV_XY"],
                accuracy["ATV"]["ATV_X"],
                accuracy["ATV"]["ATV_Y"],
                record["I290"]["PSR"]["PSR"],
            )
        )
    check_062(columns, seen)


def test_category_062_as_wireshark_reads_it(cat062, tmp_path):
    columns, datagrams = cat062
    seen = []
    for record in rows_of(by_tshark(tmp_path / "cat062.pcap", datagrams)):

        def part(item, name, record=record, base=10):
            return int(record[f"asterix.062_{item}"][f"asterix.062_{item}_{name}"], base)

        def number(item, name, record=record):
            return float(record[f"asterix.062_{item}"][f"asterix.062_{item}_{name}"])

        def accuracy(group, name, record=record):
            return float(
                record["asterix.062_500"][f"asterix.062_500_{group}"][
                    f"asterix.062_500_{group}_{name}"
                ]
            )

        named = record.get("asterix.062_245", {"asterix.062_245_CHR": ""})
        seen.append(
            (
                number("070", "VALUE"),
                number("105", "LAT"),
                number("105", "LON"),
                number("100", "X"),
                number("100", "Y"),
                number("185", "VX"),
                number("185", "VY"),
                part("040", "VALUE", base=16),
                named["asterix.062_245_CHR"].strip(),
                int(record["asterix.062_080"].get("asterix.062_080_CST", 0)),
                part("080", "TSB"),
                part("200", "TRANS"),
                accuracy("APC", "X"),
                accuracy("APC", "Y"),
                accuracy("COV", "VALUE"),
                accuracy("ATV", "X"),
                accuracy("ATV", "Y"),
                float(
                    record["asterix.062_290"]["asterix.062_290_PSR"]["asterix.062_290_PSR_VALUE"]
                ),
            )
        )
    check_062(columns, seen)


def test_category_062_as_aviconv_reads_it(cat062):
    columns, datagrams = cat062
    seen = []
    for record in rows_of(by_aviconv(datagrams)):
        assert (record["sac"], record["sic"], record["service_id"]) == (7, 9, 3)
        said = (record[key] for key in ("time_of_track_s", "lat", "lon"))
        velocity = (record["vx_ms"], record["vy_ms"])
        name = record.get("callsign", "")
        seen.append((*said, None, None, *velocity, None, name, *[None] * 9))
    check_062(columns, seen)


def test_category_062_as_libasterix_reads_it(cat062):
    base = pytest.importorskip("asterix.base")
    spec = pytest.importorskip("asterix.generated").Cat_062_1_21
    columns, datagrams = cat062
    names = []
    for datagram in datagrams:
        (block,) = base.RawDatablock.parse(base.Bits.from_bytes(datagram))
        for record in spec.cv_uap.parse(block.get_raw_records()):
            assert not isinstance(record, ValueError)
            names.append(record.get_item("040").as_uint())
    assert names == list(columns["track_id"])


def check_010(columns, seen):
    """Records as (time, latitude, longitude, x, y, speed NM/s, course, number, last, coasting,
    std x, std y, cov)."""
    latitude, longitude, course = true_course_deg(columns)
    assert len(seen) == len(columns["track_id"])
    for k, one in enumerate(seen):
        mean, covariance = columns["mean"][k], columns["covariance"][k]
        wanted = [
            (columns["estimate_time_s"][k] % DAY, 1 / 128),
            (latitude[k], 180 / 2**31),
            (longitude[k], 180 / 2**31),
            (mean[2], 1),
            (mean[0], 1),
            (math.hypot(mean[1], mean[3]) / MILE, 2**-14),
            (course[k] % 360, 360 / 2**16),
            (k + 1, 0),
            (0, 0),
            (3 if columns["coasting"][k] else 0, 0),
            (math.sqrt(covariance[2, 2]), 0.25),
            (math.sqrt(covariance[0, 0]), 0.25),
            (covariance[0, 2], 0.25),
        ]
        for place, (value, (expected, step)) in enumerate(zip(one, wanted, strict=True)):
            if value is not None:
                assert value == pytest.approx(expected, **near(step)), (k, place)


def test_category_010_as_asterix_decoder_reads_it(cat010):
    columns, datagrams = cat010
    seen = []
    for record in rows_of(by_asterix_decoder(datagrams)):
        assert record["I010"] == {"SAC": 7, "SIC": 9}
        assert record["I000"]["MsgTyp"] == 1
        assert record["I020"]["TYP"] == 3
        assert "I202" not in record
        seen.append(
            (
                record["I140"]["ToD"],
                record["I041"]["Lat"],
                record["I041"]["Lon"],
                record["I042"]["X"],
                record["I042"]["Y"],
                record["I200"]["GS"],
                record["I200"]["TA"],
                record["I161"]["TrkNb"],
                record["I170"]["TRE"],
                record["I170"]["CST"],
                record["I500"]["Qx"],
                record["I500"]["Qy"],
                record["I500"]["Qxy"],
            )
        )
    check_010(columns, seen)


def test_category_010_as_wireshark_reads_it(cat010, tmp_path):
    columns, datagrams = cat010
    seen = []
    for record in rows_of(by_tshark(tmp_path / "cat010.pcap", datagrams)):

        def part(item, name, record=record):
            return float(record[f"asterix.010_{item}"][f"asterix.010_{item}_{name}"])

        seen.append(
            (
                part("140", "VALUE"),
                part("041", "LAT"),
                part("041", "LON"),
                part("042", "X"),
                part("042", "Y"),
                part("200", "GSP"),
                part("200", "TRA"),
                part("161", "TRK"),
                part("170", "TRE"),
                part("170", "CST"),
                part("500", "DEVX"),
                part("500", "DEVY"),
                part("500", "COVXY"),
            )
        )
    check_010(columns, seen)


def test_category_010_as_aviconv_reads_it(cat010):
    columns, datagrams = cat010
    seen = []
    for record in rows_of(by_aviconv(datagrams)):
        said = [record[key] for key in ("time_of_day_s", "lat", "lon", "x_m", "y_m")]
        speed = record["ground_speed_kt"] / 3600
        course, number = record["track_angle_deg"], record["track_number"]
        seen.append((*said, speed, course, number, *[None] * 5))
    check_010(columns, seen)


@pytest.mark.parametrize("feed", [wl.wire.Cat062Feed, wl.wire.Cat010Feed])
def test_the_end_of_a_track_is_sent_once_and_its_number_rests(feed):
    feed = feed(PLANE)
    columns = tracks_at(START, count=3)
    assert len(feed.update(START, **columns)) == 1
    assert feed.numbers == {1: 1, 2: 2, 3: 3}
    fewer = {key: value[:2] for key, value in columns.items()}
    (last,) = feed.update(START + 1, **fewer)
    record = by_asterix_decoder([last])[0]
    assert len(record) == 1
    status = record[0].get("I080") or record[0]["I170"]
    assert status.get("TSE", status.get("TRE")) == 1
    assert feed.update(START + 2, **fewer) == []
    assert feed.numbers == {1: 1, 2: 2}


# --------------------------------------------------------------------------- plots of ASTERIX


@pytest.fixture(scope="module")
def oracle():
    """Categories of libasterix, made from a specification written down by others."""
    return pytest.importorskip("asterix.generated")


def octets_of(spec, records):
    made = [spec.cv_record.create(record) for record in records]
    return spec.create(made).unparse().to_bytes()


def test_plots_of_category_048_are_those_that_libasterix_wrote(oracle):
    random = np.random.default_rng(3)
    raw = random.integers(0, 65536, (200, 4))
    ticks = random.integers(0, 86400 * 128, 200)
    records = [
        {
            "010": (("SAC", 1), ("SIC", 2)),
            "140": int(tick),
            "020": ((("TYP", 1), ("SIM", int(k % 2)), ("RDP", 0), ("SPI", 0), ("RAB", 0), None),),
            "040": (("RHO", int(rho)), ("THETA", int(theta))),
            "161": (0, ("TRN", int(k))),
            "200": (("GSP", int(speed)), ("HDG", int(course))),
        }
        for k, (tick, (rho, theta, speed, course)) in enumerate(zip(ticks, raw, strict=True))
    ]
    decoder = wl.wire.AsterixDecoder()
    received = START + 100.0
    rows = decoder.decode(octets_of(oracle.Cat_048_1_32, records), received)
    assert rows.problems == []
    assert (rows.kind == 0).all()
    assert (rows.category == 48).all()
    assert (rows.source == 258).all()
    assert rows.range_m == pytest.approx(raw[:, 0] * MILE / 256, rel=1e-12)
    assert rows.bearing_rad == pytest.approx(raw[:, 1] * 2 * np.pi / 65536, rel=1e-12)
    assert rows.speed_mps == pytest.approx(raw[:, 2] * MILE / 2**14, rel=1e-12)
    assert rows.course_rad == pytest.approx(raw[:, 3] * 2 * np.pi / 65536, rel=1e-12)
    assert rows.track_number.tolist() == list(range(200))
    assert rows.test.tolist() == [k % 2 == 1 for k in range(200)]
    assert (np.abs(rows.time_s - received) <= DAY / 2).all()
    assert (rows.time_s % DAY * 128 == ticks).all()


def test_marks_of_category_034_are_those_that_libasterix_wrote(oracle):
    records = [
        {"010": (("SAC", 1), ("SIC", 2)), "000": 1, "030": 128, "041": 320},
        *({"010": (("SAC", 1), ("SIC", 2)), "000": 2, "030": 128, "020": k} for k in range(256)),
        {"010": (("SAC", 1), ("SIC", 2)), "000": 3, "030": 128},
    ]
    decoder = wl.wire.AsterixDecoder()
    rows = decoder.decode(octets_of(oracle.Cat_034_1_29, records), START)
    assert rows.kind.tolist() == [1] + 256 * [2]
    assert rows.bearing_rad[1:] == pytest.approx(2 * np.pi * np.arange(256) / 256)
    assert rows.period_s[0] == 2.5
    assert (rows.time_s == START + 1).all()
    assert decoder.other_records == 1


def test_plots_of_category_010_are_those_that_libasterix_wrote(oracle):
    source = {"010": (("SAC", 1), ("SIC", 2)), "000": 1, "140": 128}
    spec = oracle.Cat_010_1_1
    records = [
        {**source, "040": (("RHO", 1234), ("TH", 16384))},
        {**source, "042": (("X", -3000 & 0xFFFF), ("Y", 4000))},
        {**source, "041": (("LAT", 2**29), ("LON", -(2**28) & 0xFFFFFFFF))},
        {**source, "000": 2},
        {**source, "000": 3},
    ]
    decoder = wl.wire.AsterixDecoder()
    rows = decoder.decode(octets_of(spec, records), START)
    assert rows.kind.tolist() == [0, 0, 0, 1]
    assert rows.range_m[:2].tolist() == [1234.0, 5000.0]
    assert rows.bearing_rad[:2] == pytest.approx([np.pi / 2, np.arctan2(-3000, 4000) % (2 * np.pi)])
    assert np.isnan(rows.range_m[2])
    assert np.degrees([rows.latitude_rad[2], rows.longitude_rad[2]]) == pytest.approx([45.0, -22.5])
    assert decoder.other_records == 1


@given(st.binary(max_size=200), st.sampled_from([10, 34, 48]))
def test_any_octets_are_read_or_reported(octets, category):
    datagram = bytes([category]) + (3 + len(octets)).to_bytes(2, "big") + octets
    rows = wl.wire.AsterixDecoder().decode(datagram, START)
    assert len(rows) <= len(datagram)
    for offset, text, _ in rows.problems:
        assert 0 <= offset < len(datagram)
        assert f"category {category}" in text
    plots = rows.kind == 0
    placed = np.isfinite(rows.range_m[plots]) | np.isfinite(rows.latitude_rad[plots])
    assert placed.all()
    wl.wire.AsterixDecoder().decode(octets, START)


# --------------------------------------------------------------------------- NMEA 0183


def fields_of(sentence):
    text = sentence.decode("ascii")
    assert len(text) <= 82
    assert text.endswith("\r\n")
    body, checksum = text[1:-2].split("*")
    assert int(checksum, 16) == np.bitwise_xor.reduce([ord(letter) for letter in body])
    return body.split(",")


class OpenCpn:
    """Reads targets by the rules of OpenCPN (its ais_decoder.cpp): places a target by range and
    bearing from its own latest fix when the sentence comes."""

    def __init__(self):
        self.fix_deg = None
        self.heading_deg = math.nan
        self.targets = {}

    def read(self, sentence):
        """The number and place of a target, or None."""
        text = sentence.decode("ascii").rstrip("\r\n")
        if len(text) > 128:
            return None
        body, checksum = text[1:].split("*")
        if int(checksum, 16) != np.bitwise_xor.reduce([ord(letter) for letter in body]):
            return None
        fields = body.split(",")
        if fields[0][2:] == "OSD":
            self.heading_deg = float(fields[1]) if fields[1] else self.heading_deg
            return None
        assert fields[0][2:] == "TTM"
        number = int(fields[1])
        unit = {"K": 1000.0, "N": MILE, "S": 1609.344}[fields[10]]
        range_m, bearing = float(fields[2]) * unit, float(fields[3])
        if fields[4] == "R":
            bearing += self.heading_deg
        line = Geodesic.WGS84.Direct(*self.fix_deg, bearing, range_m)
        lost = range_m == 0 or fields[12] == "L"
        self.targets[number] = not lost
        return number, line["lat2"], line["lon2"], fields[11][:20], lost


def test_a_reader_by_the_rules_of_opencpn_has_every_target_within_10_m():
    """Own ship does 30 kn and turns 10 degrees a second; fixes come once a second, tracks are
    updated when the beam has passed them, up to a turn before they are sent."""
    random = np.random.default_rng(5)
    count, period = 40, 2.5
    start = np.column_stack([random.uniform(-most, most, count) for most in (9e3, 15.0, 9e3, 15.0)])
    dies_s = np.where(np.arange(count) % 4 == 0, random.uniform(20, 200, count), np.inf)
    born_s = np.where(np.arange(count) % 5 == 0, random.uniform(0, 200, count), 0.0)
    feed = wl.wire.TtmFeed(PLANE)
    reader = OpenCpn()
    speed, rate = 30 * MILE / 3600, math.radians(10)
    worst, seen = 0.0, {}
    freed, lost = {}, []
    for tick in range(240 * 4):
        t = tick / 4
        if tick % 4 == 0:
            radius = speed / rate
            place = np.array([radius * math.sin(rate * t), radius * (1 - math.cos(rate * t))])
            velocity = speed * np.array([math.cos(rate * t), math.sin(rate * t)])
            own = wl.OwnShip(
                north_m=place[0], east_m=place[1], vnorth_mps=velocity[0], veast_mps=velocity[1]
            )
            reader.fix_deg = np.degrees(PLANE.place(place))
        alive = np.flatnonzero((born_s <= t) & (t < dies_s))
        updated = np.floor((t - alive / count * period) / period) * period + alive / count * period
        mean = start[alive].copy()
        mean[:, 0] += mean[:, 1] * updated
        mean[:, 2] += mean[:, 3] * updated
        sentences = feed.update(
            START + t,
            alive + 1,
            START + updated,
            mean,
            name=[f"t{k + 1}" for k in alive],
            own=own,
            heading_rad=rate * t,
        )
        assert not sentences or fields_of(sentences[0])[0] == "RAOSD"
        for sentence in sentences:
            fields_of(sentence)
            target = reader.read(sentence)
            if target is None:
                continue
            number, latitude, longitude, name, is_lost = target
            k = int(name[1:]) - 1
            true = start[k, [0, 2]] + start[k, [1, 3]] * t
            north, east = PLANE.position_m(
                latitude_rad=math.radians(latitude), longitude_rad=math.radians(longitude)
            )
            worst = max(worst, math.hypot(north - true[0], east - true[1]))
            if is_lost:
                lost.append(k)
                freed[number] = t
                continue
            assert t - seen.get(k, -math.inf) >= 3.0  # and so once a turn at most
            if k not in seen and number in freed:
                assert t - freed[number] >= 60.0
            seen[k] = t
    assert worst < 10.0
    assert len(seen) == (born_s < dies_s).sum()
    died = np.flatnonzero((dies_s < 240) & (born_s < dies_s))
    assert sorted(lost) == [k for k in died if k in seen]


def test_a_track_that_is_back_has_its_number_again_and_others_wait():
    feed = wl.wire.TtmFeed(PLANE, interval_s=0.0)

    def numbers(time_s, track_ids):
        mean = [[1000.0 + 10.0 * k, 0.0, 0.0, 0.0] for k in track_ids]
        feed.update(START + time_s, track_ids, START + time_s, np.reshape(mean, (-1, 4)))
        return feed.numbers

    before = numbers(0.0, list(range(100)))
    assert sorted(before.values()) == list(range(100))
    numbers(10.0, [])
    assert numbers(11.0, [200]) == {}
    again = wl.wire.TtmFeed(PLANE, interval_s=0.0)
    again.restore(feed.save())
    feed = again
    assert numbers(12.0, list(range(50))) == {k: before[k] for k in range(50)}
    assert numbers(71.0, [*range(50), 200])[200] in {before[k] for k in range(50, 100)}


def test_pynmea2_reads_every_sentence_to_the_last_digit():
    pynmea2 = pytest.importorskip("pynmea2")
    for tll in (False, True):
        feed = wl.wire.TtmFeed(PLANE, tll=tll, interval_s=0)
        for k in range(20):
            columns = tracks_at(START + k, count=90, seed=k)
            sentences = feed.update(
                START + k,
                *(columns[key] for key in ("track_id", "estimate_time_s", "mean")),
                name=columns["name"],
                own=wl.OwnShip(vnorth_mps=3.0, veast_mps=-4.0),
                heading_rad=6.0,
            )
            assert len(sentences) > 1
            for sentence in sentences:
                fields = fields_of(sentence)
                read = pynmea2.parse(sentence.decode(), check=True)
                assert (read.talker + read.sentence_type, *read.data) == tuple(fields)
                assert str(read) + "\r\n" == sentence.decode()
                if read.sentence_type == "TTM":
                    assert str(read.distance) == fields[2]
                    assert read.brg_ref == read.cog_unit == "T"


def test_without_a_heading_osd_is_not_valid():
    feed = wl.wire.TtmFeed(PLANE, talker="II")
    sentences = feed.update(START, [4], START, [[100.0, 0.0, 0.0, 0.0]])
    assert [fields_of(one)[0] for one in sentences] == ["IIOSD", "IITTM"]
    assert fields_of(sentences[0])[1:3] == ["", "V"]


@given(
    st.lists(st.lists(st.floats(), min_size=4, max_size=4), min_size=1, max_size=5),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(max_size=40),
)
def test_any_track_gives_whole_sentences(mean, time_s, name):
    count = len(mean)
    for tll in (False, True):
        feed = wl.wire.TtmFeed(PLANE, tll=tll)
        names = [name] * count
        for sentence in feed.update(time_s, np.arange(count), time_s, mean, name=names):
            assert re.fullmatch(rb"\$RA(TTM|TLL|OSD)(,[ -~]*)+\*[0-9A-F]{2}\r\n", sentence)
            fields_of(sentence)
    for feed in (wl.wire.Cat062Feed(PLANE), wl.wire.Cat010Feed(PLANE)):
        for datagram in feed.update(time_s, np.arange(count), time_s, mean, name=names):
            assert int.from_bytes(datagram[1:3], "big") == len(datagram)


# --------------------------------------------------------------------------- the border


@pytest.mark.parametrize("kind", [wl.wire.TtmFeed, wl.wire.Cat062Feed, wl.wire.Cat010Feed])
def test_a_feed_goes_on_with_its_numbers_after_a_restart(kind):
    feed = kind(PLANE, hold_off_s=30.0)
    columns = tracks_at(START, count=9)
    wanted = ("track_id", "estimate_time_s", "mean")
    feed.update(START, **{key: columns[key] for key in wanted})
    feed.update(START + 1, **{key: columns[key][3:] for key in wanted})
    restarted = kind(PLANE, hold_off_s=30.0)
    restarted.restore(feed.save())
    others = [restarted, copy.copy(feed), pickle.loads(pickle.dumps(feed))]
    later = {key: tracks_at(START + 5)[key] for key in wanted}
    sent = feed.update(START + 5, **later)
    assert sent
    for other in others:
        assert other.update(START + 5, **later) == sent
        assert other.numbers == feed.numbers
    with pytest.raises(ValueError, match="different parameters"):
        kind(PLANE, hold_off_s=31.0).restore(feed.save())
    with pytest.raises(ValueError, match="save"):
        restarted.restore(feed.save()[:-1])


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"mean": np.zeros((3, 3))}, "mean"),
        ({"track_id": [[1]]}, "track_id"),
        ({"estimate_time_s": [1.0, 2.0]}, "estimate_time_s"),
        ({"covariance": np.zeros((3, 4))}, "covariance"),
        ({"coasting": [True]}, "coasting"),
        ({"name": ["a"]}, "name"),
        ({"time_s": math.nan}, "time_s"),
    ],
)
def test_columns_that_do_not_fit_are_named(changed, message):
    columns = {"time_s": START, **tracks_at(START, count=3), **changed}
    with pytest.raises(ValueError, match=message):
        wl.wire.Cat062Feed(PLANE).update(**columns)


def test_parameters_that_do_not_fit_are_named():
    with pytest.raises(ValueError, match="talker"):
        wl.wire.TtmFeed(PLANE, talker="radar")
    with pytest.raises(ValueError, match="interval_s"):
        wl.wire.TtmFeed(PLANE, interval_s=-1.0)
    with pytest.raises(ValueError, match="datagram_octets"):
        wl.wire.Cat062Feed(PLANE, datagram_octets=20)
    with pytest.raises(ValueError, match="limit_s"):
        wl.wire.SensorClock(0.0)


def test_a_clock_three_hours_off_is_put_right():
    clock = wl.wire.SensorClock()
    for k in range(100):
        assert clock(START + 3 * 3600 + k, START + k + 0.3) == pytest.approx(START + k, abs=0.4)
    assert clock.offset_s == pytest.approx(-3 * 3600, abs=0.4)
    assert clock.changes == 1
