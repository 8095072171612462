// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Recorded radar video, many sweeps a call: octets to arrays and back.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "support/thread_lock.hpp"
#include "support/types.hpp"
#include "wakeline/video/asterix_cat240_reader.hpp"
#include "wakeline/video/asterix_cat240_writer.hpp"

namespace wakeline::python {
namespace {

/// The vector's own memory as an array.
template <class T>
py::array_t<T> to_numpy(std::vector<T>&& values) {
  auto owner = std::make_unique<std::vector<T>>(std::move(values));
  T* const data = owner->data();
  const auto size = static_cast<py::ssize_t>(owner->size());
  const py::capsule base(owner.get(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
  owner.release();
  return py::array_t<T>(size, data, base);
}

std::span<const std::byte> octets_of(const py::bytes& data) {
  const std::string_view view(data);
  return {reinterpret_cast<const std::byte*>(view.data()), view.size()};
}

using ProblemTuple = std::tuple<std::uint64_t, std::string, std::string, std::string>;

ProblemTuple in_words(const Cat240Problem& problem) {
  return {problem.offset, to_string(problem.fault), wanted_text(problem), came_text(problem)};
}

/// What the columns of a decoded piece are made of.
struct Sweeps {
  std::vector<std::int64_t> offset, source, sequence, cells, bits, first, compressed;
  std::vector<double> azimuth_rad, azimuth_width_rad, time_s, start_range_m, cell_m;
  std::vector<std::uint8_t> octets;
  std::vector<std::uint16_t> words;

  void add(const Cat240Video& video) {
    offset.push_back(static_cast<std::int64_t>(video.offset));
    source.push_back(256 * video.source.area + video.source.system);
    sequence.push_back(video.sequence);
    cells.push_back(video.cells);
    bits.push_back(video.bits);
    compressed.push_back(video.compressed ? static_cast<std::int64_t>(video.packed.size()) : 0);
    if (video.compressed)
      add_compressed(video);
    else if (video.fits<std::uint8_t>())
      add_cells(video, octets);
    else
      add_cells(video, words);
  }

 private:
  template <class Amplitude>
  void add_cells(const Cat240Video& video, std::vector<Amplitude>& amplitudes) {
    const std::size_t begin = amplitudes.size();
    amplitudes.resize(begin + video.cells);
    add_sweep(begin, video.unpack(std::span<Amplitude>(amplitudes).subspan(begin)));
  }

  void add_compressed(const Cat240Video& video) {
    const std::size_t begin = octets.size();
    for (const std::byte octet : video.packed)
      octets.push_back(std::to_integer<std::uint8_t>(octet));
    add_sweep(begin, video.unpack(std::span<std::uint8_t>()));
  }

  template <class Amplitude>
  void add_sweep(std::size_t begin, const Sweep<Amplitude>& sweep) {
    first.push_back(static_cast<std::int64_t>(begin));
    azimuth_rad.push_back(sweep.azimuth_rad);
    azimuth_width_rad.push_back(sweep.azimuth_width_rad);
    time_s.push_back(sweep.time_s);
    start_range_m.push_back(sweep.start_range_m);
    cell_m.push_back(sweep.cell_m);
  }
};

struct PySweeps {
  py::array_t<std::int64_t> offset, source, sequence, cells, bits, first, compressed;
  py::array_t<double> azimuth_rad, azimuth_width_rad, time_s, start_range_m, cell_m;
  py::array_t<std::uint8_t> octets;
  py::array_t<std::uint16_t> words;
  std::vector<std::string> summaries;
  std::vector<ProblemTuple> problems;
  std::int64_t problem_count = 0;
  std::size_t consumed = 0;

  void take(Sweeps&& sweeps) {
    offset = to_numpy(std::move(sweeps.offset));
    source = to_numpy(std::move(sweeps.source));
    sequence = to_numpy(std::move(sweeps.sequence));
    cells = to_numpy(std::move(sweeps.cells));
    bits = to_numpy(std::move(sweeps.bits));
    first = to_numpy(std::move(sweeps.first));
    compressed = to_numpy(std::move(sweeps.compressed));
    azimuth_rad = to_numpy(std::move(sweeps.azimuth_rad));
    azimuth_width_rad = to_numpy(std::move(sweeps.azimuth_width_rad));
    time_s = to_numpy(std::move(sweeps.time_s));
    start_range_m = to_numpy(std::move(sweeps.start_range_m));
    cell_m = to_numpy(std::move(sweeps.cell_m));
    octets = to_numpy(std::move(sweeps.octets));
    words = to_numpy(std::move(sweeps.words));
  }
};

class Decoder {
 public:
  PySweeps decode(const py::bytes& data, bool last) {
    const std::span<const std::byte> octets = octets_of(data);
    PySweeps result;
    Sweeps sweeps;
    {
      const auto hold = lock_.hold();
      const py::gil_scoped_release release;
      read(octets, last, sweeps, result);
    }
    result.take(std::move(sweeps));
    return result;
  }

  [[nodiscard]] auto other_blocks() const {
    const auto hold = lock_.hold();
    return reader_.other_blocks();
  }
  [[nodiscard]] auto skipped_octets() const {
    const auto hold = lock_.hold();
    return reader_.skipped_octets();
  }

 private:
  static constexpr std::size_t kToldProblems = 100;  ///< so that a file of nothing else stays small

  void read(std::span<const std::byte> octets, bool last, Sweeps& sweeps, PySweeps& result) {
    reader_.feed(octets, last);
    for (auto event = reader_.next(); event != Cat240Event::kEnd; event = reader_.next()) {
      if (event == Cat240Event::kVideo) {
        sweeps.add(reader_.video());
      } else if (event == Cat240Event::kSummary) {
        if (result.summaries.size() < kToldProblems)
          result.summaries.emplace_back(reader_.summary());
      } else {
        ++result.problem_count;
        if (result.problems.size() < kToldProblems)
          result.problems.push_back(in_words(reader_.problem()));
      }
    }
    result.consumed = reader_.consumed();
  }

  Cat240Reader reader_;
  ThreadLock lock_;
};

/// The cells in octets of a record, None if they are too few.
py::object unpack(const py::bytes& octets, std::uint32_t cells, int bits) {
  Cat240Video video;
  video.bits = bits;
  video.cells = cells;
  video.compressed = true;
  video = video.decompressed(octets_of(octets));
  if (video.compressed) return py::none();
  if (video.fits<std::uint8_t>()) {
    std::vector<std::uint8_t> room(cells);
    static_cast<void>(video.unpack(std::span(room)));
    return to_numpy(std::move(room));
  }
  std::vector<std::uint16_t> room(cells);
  static_cast<void>(video.unpack(std::span(room)));
  return to_numpy(std::move(room));
}

class Encoder {
 public:
  Encoder(std::uint8_t area, std::uint8_t system) : writer_({area, system}) {}

  template <class Amplitude>
  py::bytes encode(const py::array_t<Amplitude, py::array::c_style>& amplitude,
                   const DoubleArray& azimuth_rad, const DoubleArray& time_s,
                   Sweep<Amplitude> sweep) {
    require_shape(amplitude.ndim() == 2, "amplitude", "(N, C)", amplitude);
    const py::ssize_t sweeps = amplitude.shape(0), cells = amplitude.shape(1);
    const std::string wanted = shape_text({sweeps});
    require_shape(azimuth_rad.ndim() == 1 && azimuth_rad.size() == sweeps, "azimuth_rad", wanted,
                  azimuth_rad);
    require_shape(time_s.ndim() == 1 && time_s.size() == sweeps, "time_s", wanted, time_s);
    out_.clear();
    for (py::ssize_t k = 0; k < sweeps; ++k) {
      sweep.azimuth_rad = azimuth_rad.at(k);
      sweep.time_s = time_s.at(k);
      sweep.amplitude = {amplitude.data(k, 0), static_cast<std::size_t>(cells)};
      append([&](std::span<std::byte> room) { return writer_.write(sweep, room); },
             "sweep " + std::to_string(k));
    }
    return taken();
  }

  py::bytes encode_summary(const std::string& text) {
    out_.clear();
    append([&](std::span<std::byte> room) { return writer_.write_summary(text, room); }, "summary");
    return taken();
  }

 private:
  template <class Write>
  void append(Write write, const std::string& what) {
    const Cat240Written written = write(std::span<std::byte>(room_));
    if (written != Cat240Written::kOk)
      throw py::value_error(what + " cannot be written: " + to_string(written));
    const auto* begin = reinterpret_cast<const char*>(room_.data());
    out_.append(begin, writer_.size());
  }
  [[nodiscard]] py::bytes taken() const { return py::bytes(out_); }

  Cat240Writer writer_;
  std::vector<std::byte> room_ = std::vector<std::byte>(Cat240Writer::kRoom);
  std::string out_;
};

template <class Amplitude, class Class>
void define_encode(Class& encoder) {
  encoder.def(
      "encode",
      [](Encoder& self, const py::array_t<Amplitude, py::array::c_style>& amplitude,
         const DoubleArray& azimuth_rad, const DoubleArray& time_s, double azimuth_width_rad,
         double start_range_m, double cell_m) {
        return self.encode<Amplitude>(amplitude, azimuth_rad, time_s,
                                      {.azimuth_width_rad = azimuth_width_rad,
                                       .start_range_m = start_range_m,
                                       .cell_m = cell_m,
                                       .amplitude = {}});
      },
      py::arg("amplitude").noconvert(), py::arg("azimuth_rad"), py::arg("time_s"),
      py::arg("azimuth_width_rad"), py::arg("start_range_m"), py::arg("cell_m"),
      R"doc(The blocks of some sweeps, one each.

Parameters
----------
amplitude : (N, C) array of uint8 or uint16
azimuth_rad, time_s : (N,) array
azimuth_width_rad, start_range_m, cell_m : float

Raises
------
ValueError
    When a sweep cannot be written: too many cells, or a length that the format cannot represent.
)doc");
}

}  // namespace

void define_video_asterix(py::module_& m) {
  py::class_<PySweeps>(m, "Cat240Sweeps",
                       R"doc(Sweeps decoded from a piece of a file, one per row.

`first` is the index of a sweep's first cell in `octets` (8 bits and fewer, scaled to 8) or in `words`
(16 bits). Where `compressed` is not 0 it is a number of octets from there on; decompress them and
call `Cat240Decoder.unpack`. `source` is 256 SAC + SIC; `sequence` is -1 and `time_s` NaN if missing. `problems` has the
first 100 as (offset, problem, wanted, got).
)doc")
      .def_readonly("offset", &PySweeps::offset, "(n,) of the record in the file, in octets.")
      .def_readonly("source", &PySweeps::source, "(n,) 256 SAC + SIC.")
      .def_readonly("sequence", &PySweeps::sequence, "(n,) number of the message; -1 if missing.")
      .def_readonly("cells", &PySweeps::cells, "(n,) cells of each sweep.")
      .def_readonly("bits", &PySweeps::bits, "(n,) of each amplitude: 1, 2, 4, 8, 16 or 32.")
      .def_readonly("first", &PySweeps::first,
                    "(n,) index of its first cell in `octets` or `words`.")
      .def_readonly("compressed", &PySweeps::compressed,
                    "(n,) octets of a compressed sweep; else 0.")
      .def_readonly("azimuth_rad", &PySweeps::azimuth_rad,
                    "(n,) clockwise from north, where the sweep begins.")
      .def_readonly("azimuth_width_rad", &PySweeps::azimuth_width_rad, "(n,) width of the sweep.")
      .def_readonly("time_s", &PySweeps::time_s, "(n,) time of day; NaN if missing.")
      .def_readonly("start_range_m", &PySweeps::start_range_m, "(n,) range of the first cell.")
      .def_readonly("cell_m", &PySweeps::cell_m, "(n,) length of a cell.")
      .def_readonly("octets", &PySweeps::octets, "Amplitudes of up to 8 bits, scaled to 8.")
      .def_readonly("words", &PySweeps::words, "Amplitudes of 16 bits.")
      .def_property_readonly(
          "summaries",
          [](const PySweeps& self) {
            std::vector<py::bytes> all;
            for (const std::string& text : self.summaries) all.emplace_back(text);
            return all;
          },
          "Video summaries, octets as the radar sent them.")
      .def_readonly("problems", &PySweeps::problems,
                    "The first 100, each (offset, problem, wanted, got).")
      .def_readonly("problem_count", &PySweeps::problem_count, "Of all problems.")
      .def_readonly("consumed", &PySweeps::consumed,
                    "Octets used; the rest belongs before the next piece.");
  py::class_<Decoder>(m, "Cat240Decoder", "ASTERIX category 240 to arrays, piece by piece.")
      .def(py::init())
      .def("decode", &Decoder::decode, py::arg("data"), py::arg("last"),
           R"doc(The sweeps of a piece of a file.

Parameters
----------
data : bytes
    The rest of the previous piece (all but its first `consumed` octets) and what follows.
last : bool
    Whether this is the last piece.
)doc")
      .def_static("unpack", &unpack, py::arg("octets"), py::arg("cells"), py::arg("bits"),
                  R"doc(The cells of a sweep from its decompressed octets.

Parameters
----------
octets : bytes
cells, bits : int
    Number of cells, and bits of each: 1, 2, 4, 8 or 16.

Returns
-------
(cells,) array of uint8 or uint16, or None
    None for too few octets.
)doc")
      .def_property_readonly("other_blocks", &Decoder::other_blocks,
                             "Blocks of other categories so far.")
      .def_property_readonly("skipped_octets", &Decoder::skipped_octets,
                             "Octets skipped because of damage so far.");
  py::class_<Encoder> encoder(m, "Cat240Encoder", "Sweeps to ASTERIX category 240.");
  encoder.def(py::init<std::uint8_t, std::uint8_t>(), py::arg("area") = 0, py::arg("system") = 0);
  define_encode<std::uint8_t>(encoder);
  define_encode<std::uint16_t>(encoder);
  encoder.def("encode_summary", &Encoder::encode_summary, py::arg("text"),
              "The block of a description of the video, at most 255 ASCII characters.");
}

}  // namespace wakeline::python
