// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <map>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "support/arguments.hpp"
#include "support/thread_lock.hpp"
#include "support/types.hpp"
#include "support/video.hpp"
#include "wakeline/video/cfar.hpp"
#include "wakeline/video/land_mask.hpp"
#include "wakeline/video/plot_extractor.hpp"
#include "wakeline/video/scan_image.hpp"
#include "wakeline/video/static_clutter_map.hpp"

namespace wakeline::python {
namespace {

const std::map<std::string, CfarKind> kKinds{{"cell_averaging", CfarKind::kCellAveraging},
                                             {"ordered_statistic", CfarKind::kOrderedStatistic}};
const std::map<std::string, Noise> kNoises{{"exponential", Noise::kExponential},
                                           {"rayleigh", Noise::kRayleigh}};

/// The meaning of a word; throws ValueError with the known words.
template <class Meaning>
Meaning meaning(const char* name, const std::map<std::string, Meaning>& words,
                const std::string& word) {
  if (const auto found = words.find(word); found != words.end()) return found->second;
  std::string known;
  for (const auto& [other, unused] : words) known += (known.empty() ? "" : " or ") + other;
  throw py::value_error(std::string(name) + " must be " + known + ", got " + quoted(word));
}

CfarSettings cfar_settings(const std::string& kind, int train_cells, int guard_cells,
                           double threshold_factor, int threshold_offset, double rank,
                           int least_amplitude) {
  const CfarSettings settings{.kind = meaning("kind", kKinds, kind),
                              .train_cells = train_cells,
                              .guard_cells = guard_cells,
                              .threshold_factor = threshold_factor,
                              .threshold_offset = threshold_offset,
                              .rank = rank,
                              .least_amplitude = least_amplitude};
  settings.validate();
  return settings;
}

// CFAR
// ---------------------------------------------------------------------------------------------

/// Calls `use(amplitude, threshold, cells)` for each row.
template <class Array, class Use>
void for_each_sweep(const Array& amplitude, const CfarSettings& settings, Use&& use) {
  using Amplitude = typename Array::value_type;
  const auto cells = static_cast<std::size_t>(amplitude.shape(1));
  Cfar<Amplitude> cfar(settings, static_cast<int>(std::min<std::size_t>(cells, 1 << 20)));
  std::vector<Amplitude> threshold(cells);
  const Amplitude* row = amplitude.data();
  const py::ssize_t rows = amplitude.shape(0);
  const py::gil_scoped_release release;
  for (py::ssize_t k = 0; k < rows; ++k, row += cells) {
    cfar.thresholds({row, cells}, threshold);
    use(row, threshold);
  }
}

py::array_t<bool> cfar(const py::object& amplitude, const std::string& kind, int train_cells,
                       int guard_cells, double factor, int offset, double rank,
                       int least_amplitude) {
  const CfarSettings settings =
      cfar_settings(kind, train_cells, guard_cells, factor, offset, rank, least_amplitude);
  return with_amplitude(amplitude, [&]<class Array>(const Array& array) {
    py::array_t<bool> above({array.shape(0), array.shape(1)});
    bool* to = above.mutable_data();
    for_each_sweep(array, settings, [&](const auto* row, const auto& threshold) {
      for (std::size_t i = 0; i < threshold.size(); ++i) *to++ = row[i] > threshold[i];
    });
    return above;
  });
}

py::array cfar_threshold(const py::object& amplitude, const std::string& kind, int train_cells,
                         int guard_cells, double factor, int offset, double rank,
                         int least_amplitude) {
  const CfarSettings settings =
      cfar_settings(kind, train_cells, guard_cells, factor, offset, rank, least_amplitude);
  return with_amplitude(amplitude, [&]<class Array>(const Array& array) -> py::array {
    using Amplitude = typename Array::value_type;
    py::array_t<Amplitude> thresholds({array.shape(0), array.shape(1)});
    Amplitude* to = thresholds.mutable_data();
    for_each_sweep(array, settings, [&](const auto*, const auto& threshold) {
      to = std::copy(threshold.begin(), threshold.end(), to);
    });
    return thresholds;
  });
}

// Plots
// --------------------------------------------------------------------------------------------

/// Plots as arrays.
struct PyVideoPlots {
  py::array_t<double> time_s, range_m, bearing_rad, covariance, range_extent_m, bearing_extent_rad,
      peak_amplitude, total_amplitude;
  py::array_t<std::int64_t> cells;
  py::array_t<bool> touches_first_cell, touches_last_cell, cut;
};

/// One field of all plots.
template <class T, class Field>
py::array_t<T> gathered(const std::vector<VideoPlot>& plots, Field VideoPlot::*field) {
  py::array_t<T> values(static_cast<py::ssize_t>(plots.size()));
  T* to = values.mutable_data();
  for (const VideoPlot& plot : plots) *to++ = static_cast<T>(plot.*field);
  return values;
}

PyVideoPlots to_table(const std::vector<VideoPlot>& plots) {
  py::array_t<double> covariance(
      {static_cast<py::ssize_t>(plots.size()), py::ssize_t{2}, py::ssize_t{2}});
  double* to = covariance.mutable_data();
  for (const VideoPlot& plot : plots)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) *to++ = plot.covariance(i, j);
  return {gathered<double>(plots, &VideoPlot::time_s),
          gathered<double>(plots, &VideoPlot::range_m),
          gathered<double>(plots, &VideoPlot::bearing_rad),
          std::move(covariance),
          gathered<double>(plots, &VideoPlot::range_extent_m),
          gathered<double>(plots, &VideoPlot::bearing_extent_rad),
          gathered<double>(plots, &VideoPlot::peak_amplitude),
          gathered<double>(plots, &VideoPlot::total_amplitude),
          gathered<std::int64_t>(plots, &VideoPlot::cells),
          gathered<bool>(plots, &VideoPlot::touches_first_cell),
          gathered<bool>(plots, &VideoPlot::touches_last_cell),
          gathered<bool>(plots, &VideoPlot::cut)};
}

/// An extractor of 8 or 16 bits, as the first video has them.
class AnyPlotExtractor {
 public:
  AnyPlotExtractor(const PlotExtractorSettings& settings, LandMask land, StaticClutterMap clutter)
      : settings_(settings), land_(std::move(land)), clutter_(std::move(clutter)) {
    settings.validate();
  }

  PyVideoPlots process(const py::object& video) {
    return with_video(video, [&]<class Amplitude>(const Video<Amplitude>& sweeps) {
      const auto hold = lock_.hold();
      PlotExtractor<Amplitude>& extractor = of_amplitude<Amplitude>();
      std::vector<VideoPlot> plots;
      {
        const py::ssize_t count = sweeps.size();
        const py::gil_scoped_release release;
        for (py::ssize_t k = 0; k < count; ++k)
          for (const VideoPlot& plot : extractor.process(sweeps.sweep(k))) plots.push_back(plot);
      }
      return to_table(plots);
    });
  }

  PyVideoPlots finish() {
    std::vector<VideoPlot> plots;
    if_running([&](auto& extractor) {
      const auto closed = extractor.finish();
      plots.assign(closed.begin(), closed.end());
    });
    return to_table(plots);
  }

  [[nodiscard]] ExtractionCounts counts() {
    ExtractionCounts counts;
    if_running([&](auto& extractor) { counts = extractor.counts(); });
    return counts;
  }

  [[nodiscard]] std::int64_t open_echoes() {
    std::int64_t open = 0;
    if_running([&](auto& e) { open = static_cast<std::int64_t>(e.open_echoes()); });
    return open;
  }

  [[nodiscard]] double open_extent_rad() {
    double extent_rad = 0.0;
    if_running([&](auto& extractor) { extent_rad = extractor.open_extent_rad(); });
    return extent_rad;
  }

  [[nodiscard]] StaticClutterMap clutter() {
    const auto hold = lock_.hold();
    StaticClutterMap map = clutter_;
    if_running([&](auto& extractor) { map = extractor.clutter(); });
    return map;
  }

  void set_land(const LandMask& land) {
    const auto hold = lock_.hold();
    land_ = land;
    if_running([&](auto& extractor) { extractor.set_land(land); });
  }

 private:
  template <class Amplitude>
  PlotExtractor<Amplitude>& of_amplitude() {
    using Extractor = PlotExtractor<Amplitude>;
    if (std::holds_alternative<std::monostate>(extractor_))
      extractor_.emplace<Extractor>(settings_, land_, clutter_);
    if (auto* extractor = std::get_if<Extractor>(&extractor_)) return *extractor;
    throw py::value_error(sizeof(Amplitude) == 1
                              ? "amplitude must be of uint16 as in the video before, got uint8"
                              : "amplitude must be of uint8 as in the video before, got uint16");
  }

  template <class Use>
  void if_running(Use&& use) {
    const auto hold = lock_.hold();
    std::visit(
        [&]<class Extractor>(Extractor& extractor) {
          if constexpr (!std::is_same_v<Extractor, std::monostate>) use(extractor);
        },
        extractor_);
  }

  PlotExtractorSettings settings_;
  LandMask land_;
  StaticClutterMap clutter_;
  std::variant<std::monostate, PlotExtractor<std::uint8_t>, PlotExtractor<std::uint16_t>>
      extractor_;
  ThreadLock lock_;
};

// The picture
// --------------------------------------------------------------------------------------

class AnyScanImage {
 public:
  AnyScanImage(int sweeps, int cells, int bits, double first_azimuth_rad)
      : image_(ScanImage<std::uint8_t>(3, 1)) {
    if (bits != 8 && bits != 16)
      throw py::value_error("bits must be 8 or 16, got " + std::to_string(bits));
    if (bits == 8)
      image_ = ScanImage<std::uint8_t>(sweeps, cells, first_azimuth_rad);
    else
      image_ = ScanImage<std::uint16_t>(sweeps, cells, first_azimuth_rad);
  }

  /// The number of sweeps taken.
  py::ssize_t add(const py::object& video) {
    return with_video(video, [&]<class Amplitude>(const Video<Amplitude>& sweeps) {
      auto* image = std::get_if<ScanImage<Amplitude>>(&image_);
      if (image == nullptr)
        throw py::value_error(sizeof(Amplitude) == 1
                                  ? "amplitude must be of uint16 as the image, got uint8"
                                  : "amplitude must be of uint8 as the image, got uint16");
      const auto hold = lock_.hold();
      const py::ssize_t count = sweeps.size();
      py::ssize_t taken = 0;
      const py::gil_scoped_release release;
      for (py::ssize_t k = 0; k < count; ++k) taken += image->add(sweeps.sweep(k));
      return taken;
    });
  }

  void clear() {
    const auto hold = lock_.hold();
    std::visit([](auto& image) { image.clear(); }, image_);
  }

  /// Calls `use(view)`.
  template <class Use>
  auto with_view(Use&& use) const {
    const auto hold = lock_.hold();
    return std::visit([&](const auto& image) { return use(image.view()); }, image_);
  }

 private:
  std::variant<ScanImage<std::uint8_t>, ScanImage<std::uint16_t>> image_;
  ThreadLock lock_;
};

double step_of(const AnyScanImage& image) {
  return image.with_view([](const auto& view) { return view.azimuth_step_rad; });
}

/// The image's own memory, not to be written to.
py::array view_of(const py::object& self) {
  return self.cast<const AnyScanImage&>().with_view(
      [&]<class Amplitude>(const AmplitudeImage<Amplitude>& view) -> py::array {
        py::array_t<Amplitude> array({py::ssize_t{view.sweeps}, py::ssize_t{view.cells}},
                                     view.amplitudes, self);
        array.attr("setflags")(py::arg("write") = false);
        return array;
      });
}

/// The centres of rows or cells.
template <class Centre>
py::array_t<double> centres(int count, Centre&& centre) {
  py::array_t<double> array(count);
  for (int k = 0; k < count; ++k) array.mutable_at(k) = centre(k);
  return array;
}

// What Python sees
// ---------------------------------------------------------------------------------

void define_cfar(py::module_& m) {
  const CfarSettings d;
  m.def("cfar", &cfar, py::arg("amplitude"), py::kw_only(), py::arg("kind") = "cell_averaging",
        py::arg("train_cells") = d.train_cells, py::arg("guard_cells") = d.guard_cells,
        py::arg("threshold_factor") = d.threshold_factor,
        py::arg("threshold_offset") = d.threshold_offset, py::arg("rank") = d.rank,
        py::arg("least_amplitude") = d.least_amplitude,
        R"(Detect cells that exceed their neighbors in range at a constant false alarm rate (CFAR).

Parameters
----------
amplitude : (N, C) array of uint8 or uint16
    Range cells of each sweep.
kind : str
    cell_averaging compares a cell with the mean of its training cells, ordered_statistic with the
    k-th smallest.
train_cells : int
    Training cells on each side, 1 to 128; at the ends of a sweep those that exist.
guard_cells : int
    Guard cells on each side, next to the cell, which are excluded.
threshold_factor : float
    Multiplies the mean or the k-th smallest; see `threshold_factor`.
threshold_offset : int
    Added to the product. Video of a logarithmic receiver needs a factor of 1 and an offset; see
    `threshold_offset_db`.
rank : float
    k / number of training cells; ordered_statistic only.
least_amplitude : int
    Smaller amplitudes are never detected.

Returns
-------
(N, C) bool array)");
  m.def("cfar_threshold", &cfar_threshold, py::arg("amplitude"), py::kw_only(),
        py::arg("kind") = "cell_averaging", py::arg("train_cells") = d.train_cells,
        py::arg("guard_cells") = d.guard_cells, py::arg("threshold_factor") = d.threshold_factor,
        py::arg("threshold_offset") = d.threshold_offset, py::arg("rank") = d.rank,
        py::arg("least_amplitude") = d.least_amplitude,
        R"(Thresholds of the cells: (N, C) of the amplitudes' type.

Parameters as for `cfar`.)");
  m.def(
      "threshold_factor",
      [](double probability, const std::string& noise, const std::string& kind, int train_cells,
         double rank) {
        const CfarSettings settings = cfar_settings(kind, train_cells, 0, 1.0, 0, rank, 1);
        return threshold_factor(settings, meaning("noise", kNoises, noise), probability);
      },
      py::arg("probability"), py::kw_only(), py::arg("noise") = "rayleigh",
      py::arg("kind") = "cell_averaging", py::arg("train_cells") = d.train_cells,
      py::arg("rank") = d.rank,
      R"(The threshold factor for a given probability of false alarm.

With N = 2 `train_cells`, factor f and p the probability::

    cell_averaging     exponential   p = (1 + f / N)^-N
                       rayleigh      p = (1 + f^2 b / N)^-N,   b = pi/4 + (1 - pi/4) / N
    ordered_statistic  exponential   p = prod_{i<k} (N - i) / (N - i + f),   k = ceil(rank N)
                       rayleigh      the same with f^2

The second approximates the distribution of a mean of Rayleigh amplitudes: with 8 to 16 training cells and a
probability of 1e-4 to 1e-6 false alarms are 10 to 30 % more frequent. The others are exact.

Parameters
----------
probability : float
    For a cell of independent noise with all training cells.
noise : str
    Distribution of the amplitudes: exponential after a square-law detector, rayleigh after a
    linear one.
kind, train_cells, rank
    As for `cfar`.)");
  m.def(
      "false_alarm_probability",
      [](double factor, const std::string& noise, const std::string& kind, int train_cells,
         double rank) {
        return false_alarm_probability(cfar_settings(kind, train_cells, 0, factor, 0, rank, 1),
                                       meaning("noise", kNoises, noise));
      },
      py::arg("threshold_factor"), py::kw_only(), py::arg("noise") = "rayleigh",
      py::arg("kind") = "cell_averaging", py::arg("train_cells") = d.train_cells,
      py::arg("rank") = d.rank, "Inverse of `threshold_factor`: the probability of false alarm.");
  m.def(
      "threshold_offset_db", &threshold_offset_db, py::arg("probability"),
      R"(The threshold above the mean level for a logarithmic receiver and a probability of false alarm.

``10 lg(-ln p) + 2.507`` decibels; multiplied by the receiver's steps per decibel it is the
`threshold_offset`, with a `threshold_factor` of 1. Exact for many training cells.)");
}

void define_masks(py::module_& m) {
  py::class_<LandMask>(m, "LandMask", R"(Areas around the antenna without detections.

It holds the excluded ranges of each direction; a cell that is partly inside an area is excluded.

Parameters
----------
azimuths : int
    Directions per revolution.)")
      .def(py::init<int>(), py::arg("azimuths") = 4096)
      .def_property_readonly("azimuths", &LandMask::azimuths)
      .def(
          "exclude_sector", &LandMask::exclude_sector, py::arg("from_azimuth_rad"),
          py::arg("to_azimuth_rad"), py::arg("near_m"), py::arg("far_m"),
          R"(Exclude ranges in the directions clockwise from one azimuth to another, also across north;
           a full revolution if they differ by 2 pi.)")
      .def(
          "exclude_polygon",
          [](LandMask& mask, const DoubleArray& corners_m) {
            require_shape(corners_m.ndim() == 2 && corners_m.shape(1) == 2, "corners_m", "(k, 2)",
                          corners_m);
            std::vector<Vec<double, 2>> corners;
            for (py::ssize_t k = 0; k < corners_m.shape(0); ++k)
              corners.emplace_back(corners_m.at(k, 0), corners_m.at(k, 1));
            mask.exclude_polygon(corners);
          },
          py::arg("corners_m"),
          R"(Exclude the inside of a polygon.

Parameters
----------
corners_m : (k, 2) array
    North and east of the antenna, which may be inside.)")
      .def("excludes", &LandMask::excludes, py::arg("azimuth_rad"), py::arg("range_m"),
           "Whether a position is excluded.");
  py::class_<StaticClutterMap> clutter(m, "StaticClutterMap",
                                       R"(Static clutter: the mean amplitude of each cell.

A cell must exceed `factor` times its mean over the last `time_constant_s`. Land and buoys vanish
after ``time_constant_s * log(factor / (factor - 1))``, and so does a stationary ship.

Parameters
----------
azimuths : int
    Rows per revolution; of several sweeps in a row the largest amplitudes are learned.
cells : int
    Range cells; cells beyond are ignored.
time_constant_s : float
    Well above the time in which the slowest ship of interest moves by the size of its echo.
factor : float
    A cell must exceed this times its mean amplitude.)");
  define_copies(clutter);
  clutter
      .def("_arguments",
           [](const StaticClutterMap& map) {
             return Arguments()
                 .with("azimuths", map.azimuths())
                 .with("cells", map.cells())
                 .with("time_constant_s", map.time_constant_s())
                 .with("factor", map.factor());
           })
      .def(py::init<int, int, double, double>(), py::arg("azimuths"), py::arg("cells"),
           py::arg("time_constant_s"), py::arg("factor") = 1.5)
      .def_property_readonly("azimuths", &StaticClutterMap::azimuths)
      .def_property_readonly("cells", &StaticClutterMap::cells)
      .def_property_readonly(
          "mean",
          [](const StaticClutterMap& map) {
            return py::array_t<float>({py::ssize_t{map.azimuths()}, py::ssize_t{map.cells()}},
                                      map.mean().data());
          },
          "(azimuths, cells) float32: mean amplitudes.");
}

void define_plots(py::module_& m) {
  py::class_<PyVideoPlots>(m, "VideoPlots",
                           "Plots of radar video as arrays, in order of the ends of "
                           "their echoes.")
      .def_readonly("time_s", &PyVideoPlots::time_s, "(n,) amplitude-weighted means.")
      .def_readonly("range_m", &PyVideoPlots::range_m, "(n,) amplitude-weighted means.")
      .def_readonly("bearing_rad", &PyVideoPlots::bearing_rad,
                    "(n,) amplitude-weighted means, clockwise from north, 0 to 2 pi.")
      .def_readonly(
          "covariance", &PyVideoPlots::covariance,
          "(n, 2, 2) of range_m and bearing_rad: weighted spread of the echo divided by its "
          "effective number of cells, plus a twelfth of a cell's and a sweep's square.")
      .def_readonly("range_extent_m", &PyVideoPlots::range_extent_m,
                    "(n,) from the first to the last cell of the echo.")
      .def_readonly("bearing_extent_rad", &PyVideoPlots::bearing_extent_rad,
                    "(n,) from the first to the last sweep of the echo.")
      .def_readonly("peak_amplitude", &PyVideoPlots::peak_amplitude, "(n,) largest amplitude.")
      .def_readonly("total_amplitude", &PyVideoPlots::total_amplitude,
                    "(n,) sum of the amplitudes.")
      .def_readonly("cells", &PyVideoPlots::cells, "(n,) cells above their thresholds.")
      .def_readonly("touches_first_cell", &PyVideoPlots::touches_first_cell,
                    "(n,) true where the echo may begin before the video.")
      .def_readonly("touches_last_cell", &PyVideoPlots::touches_last_cell,
                    "(n,) true where the echo may continue beyond the video.")
      .def_readonly("cut", &PyVideoPlots::cut,
                    "(n,) true where the plot may be a part of an echo: closed at `max_sweeps`, or "
                    "next to missing sweeps.")
      .def("__len__", [](const PyVideoPlots& plots) { return plots.range_m.shape(0); });
  py::class_<ExtractionCounts>(m, "ExtractionCounts",
                               "Counts of the sweeps and echoes of an extractor.")
      .def_readonly("sweeps", &ExtractionCounts::sweeps, "Used.")
      .def_readonly("gaps", &ExtractionCounts::gaps, "Number of gaps in the sweeps.")
      .def_readonly("reversals", &ExtractionCounts::reversals,
                    "Number of steps back of the antenna.")
      .def_readonly("geometry_changes", &ExtractionCounts::geometry_changes,
                    "Number of changes of start range or cell length.")
      .def_readonly("repeated", &ExtractionCounts::repeated,
                    "Sweeps rejected at the azimuth of the last one.")
      .def_readonly("too_long", &ExtractionCounts::too_long, "Sweeps rejected for their length.")
      .def_readonly("invalid", &ExtractionCounts::invalid, "Invalid sweeps, rejected.")
      .def_readonly("plots", &ExtractionCounts::plots, "Number of plots.")
      .def_readonly("too_small", &ExtractionCounts::too_small, "Echoes too small for a plot.")
      .def_readonly("too_large", &ExtractionCounts::too_large, "Echoes too large for a plot.")
      .def_readonly("cut", &ExtractionCounts::cut, "Plots that may be parts of echoes.");

  const PlotExtractorSettings d;
  py::class_<AnyPlotExtractor>(m, "PlotExtractor",
                               R"(Extracts plots from sweeps; a plot is complete when its echo ends.

CFAR along range; connected cells are one echo, from sweep to sweep and across revolutions. A missing
sweep closes the echoes it would have touched, and so does a step back of the antenna or a change of
the cell length; invalid sweeps are rejected; see `counts`. Memory is allocated once.

Parameters
----------
kind, train_cells, guard_cells, threshold_factor, threshold_offset, rank, least_amplitude
    As of `cfar`.
max_sweep_cells : int
    Longer sweeps are rejected.
gap_cells, gap_sweeps : int
    Gaps allowed within an echo.
min_cells, max_cells : int
    Smaller and larger echoes give no plot.
max_range_extent_m, max_bearing_extent_rad : float
    Longer and wider echoes give no plot.
max_sweeps : int
    An echo is closed after this many sweeps; the rest is another echo, and both are marked as `cut`.
closed_circle : bool
    Each revolution is a separate picture whose last sweeps are connected with its first ones.
    Otherwise revolutions follow each other.
land : LandMask, optional
    Areas without detections.
clutter : StaticClutterMap, optional
    Static clutter; the extractor learns with a copy.)")
      .def(py::init([](const std::string& kind, int train_cells, int guard_cells, double factor,
                       int offset, double rank, int least_amplitude, int max_sweep_cells,
                       int gap_cells, int gap_sweeps, int min_cells, int max_cells,
                       double max_range_extent_m, double max_bearing_extent_rad, int max_sweeps,
                       bool closed_circle, const std::optional<LandMask>& land,
                       const std::optional<StaticClutterMap>& clutter) {
             return AnyPlotExtractor({.cfar = cfar_settings(kind, train_cells, guard_cells, factor,
                                                            offset, rank, least_amplitude),
                                      .max_sweep_cells = max_sweep_cells,
                                      .gap_cells = gap_cells,
                                      .gap_sweeps = gap_sweeps,
                                      .min_cells = min_cells,
                                      .max_cells = max_cells,
                                      .max_range_extent_m = max_range_extent_m,
                                      .max_bearing_extent_rad = max_bearing_extent_rad,
                                      .max_sweeps = max_sweeps,
                                      .closed_circle = closed_circle},
                                     land.value_or(LandMask()),
                                     clutter.value_or(StaticClutterMap()));
           }),
           py::kw_only(), py::arg("kind") = "cell_averaging",
           py::arg("train_cells") = d.cfar.train_cells, py::arg("guard_cells") = d.cfar.guard_cells,
           py::arg("threshold_factor") = d.cfar.threshold_factor,
           py::arg("threshold_offset") = d.cfar.threshold_offset, py::arg("rank") = d.cfar.rank,
           py::arg("least_amplitude") = d.cfar.least_amplitude,
           py::arg("max_sweep_cells") = d.max_sweep_cells, py::arg("gap_cells") = d.gap_cells,
           py::arg("gap_sweeps") = d.gap_sweeps, py::arg("min_cells") = d.min_cells,
           py::arg("max_cells") = d.max_cells, py::arg("max_range_extent_m") = d.max_range_extent_m,
           py::arg("max_bearing_extent_rad") = d.max_bearing_extent_rad,
           py::arg("max_sweeps") = d.max_sweeps, py::arg("closed_circle") = d.closed_circle,
           py::arg("land") = py::none(), py::arg("clutter") = py::none())
      .def("process", &AnyPlotExtractor::process, py::arg("video"),
           R"(Process the sweeps of a video, which continue the previous ones.

Returns
-------
VideoPlots
    Plots of the echoes that ended.)")
      .def("finish", &AnyPlotExtractor::finish,
           "Close all open echoes and return their plots. The extractor is then ready for other "
           "sweeps, with its counts and clutter map.")
      .def("set_land", &AnyPlotExtractor::set_land, py::arg("land"),
           "Replace the areas, from the next sweep on.")
      .def_property_readonly("counts", &AnyPlotExtractor::counts,
                             "Sweeps and echoes so far, as ExtractionCounts.")
      .def_property_readonly("open_echoes", &AnyPlotExtractor::open_echoes,
                             "Number of open echoes.")
      .def_property_readonly("open_extent_rad", &AnyPlotExtractor::open_extent_rad,
                             "Angle that the beam has swept since the first of the open echoes "
                             "began: plots that are still to come are in it or ahead of it.")
      .def_property_readonly("clutter", &AnyPlotExtractor::clutter,
                             "A copy of what the extractor has learned of static clutter.");
}

void define_image(py::module_& m) {
  py::class_<AnyScanImage>(m, "ScanImage",
                           R"(The picture of the last revolution on a regular polar grid.

Consecutive sweeps in one row leave the larger amplitude; a row to which the beam returns is
overwritten.

Parameters
----------
sweeps, cells : int
    Rows per revolution, and range cells of each.
bits : int
    8 or 16.
first_azimuth_rad : float
    Of row 0.)")
      .def(py::init<int, int, int, double>(), py::arg("sweeps"), py::arg("cells"), py::kw_only(),
           py::arg("bits") = 8, py::arg("first_azimuth_rad") = 0.0)
      .def("add", &AnyScanImage::add, py::arg("video"),
           "Add the sweeps of a video; returns the number of valid ones. "
           "Another start range or cell length clears the image first.")
      .def("clear", &AnyScanImage::clear, "Set all amplitudes to 0, as before the first sweep.")
      .def_property_readonly("amplitude", &view_of,
                             "(sweeps, cells) of uint8 or uint16: the image's own memory, which "
                             "changes with it.")
      .def_property_readonly(
          "first_azimuth_rad",
          [](const AnyScanImage& image) {
            return image.with_view([](const auto& view) { return view.first_azimuth_rad; });
          })
      .def_property_readonly("azimuth_step_rad", &step_of, "From one row to the next.")
      .def_property_readonly("azimuth_width_rad", &step_of, "Width of a row.")
      .def("__len__",
           [](const AnyScanImage& image) {
             return image.with_view([](const auto& view) { return view.sweeps; });
           })
      .def_property_readonly(
          "start_range_m",
          [](const AnyScanImage& image) {
            return image.with_view([](const auto& view) { return view.start_range_m; });
          },
          "Range of the first cell.")
      .def_property_readonly(
          "cell_m",
          [](const AnyScanImage& image) {
            return image.with_view([](const auto& view) { return view.cell_m; });
          },
          "Length of a cell.")
      .def_property_readonly(
          "azimuth_rad",
          [](const AnyScanImage& image) {
            return image.with_view([](const auto& view) {
              return centres(view.sweeps, [&](int k) { return view.azimuth_rad(k); });
            });
          },
          "(sweeps,) centers of the rows.")
      .def_property_readonly(
          "range_m",
          [](const AnyScanImage& image) {
            return image.with_view([](const auto& view) {
              return centres(view.cells, [&](int k) { return view.range_m(k); });
            });
          },
          "(cells,) centers of the cells.");
}

}  // namespace

void define_video(py::module_& parent) {
  py::module_ m = parent.def_submodule("video", "Plots from radar video.");
  define_cfar(m);
  define_masks(m);
  define_plots(m);
  define_image(m);
  define_video_asterix(m);
}

}  // namespace wakeline::python
