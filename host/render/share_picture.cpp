#include "render/share_picture.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/trace.hpp"
#include "luciole/error.hpp"
#include "raster/bins.hpp"
#include "render/bands.hpp"
#include "render/validate.hpp"

namespace luciole {
namespace {

/// The first bands of all devices, whose speeds aren't known yet, are together one part of so many.
constexpr int kFirstPart = 8;
/// A device takes half of its share of the rows that are left, so that speeds that change are evened out
/// later.
constexpr double kShareTaken = 0.5;
/// A device may be so many bands ahead of the rows given to the caller: waiting bands take memory.
constexpr int kMostAhead = 4;

/// The state of a picture's rows, shared by the devices' threads.
struct SharedRows {
  int bottom;                       ///< the picture's end
  int next;                         ///< the first row that no device has taken
  int taken;                        ///< the first row that the caller's sink hasn't got
  int working;                      ///< devices at work
  std::vector<Band> returned = {};  ///< by devices that failed
  std::map<int, Image> done = {};   ///< by first row
  std::exception_ptr failure = {};  ///< not null: all threads stop
  std::mutex mutex = {};
  std::condition_variable changed = {};
};

/// The height of the next band of a device, by its speed. rows.mutex must be held.
double wantedRows(const std::list<Sharer>& sharers, const Sharer& mine, const SharedRows& rows, int height) {
  double rates = 0;
  int count = 0;
  bool all_known = true;
  for (const Sharer& sharer : sharers) {
    if (!sharer.error.empty()) continue;
    ++count;
    all_known &= sharer.milliseconds > 0;
    rates += sharer.milliseconds > 0 ? sharer.rows / sharer.milliseconds : 0;
  }
  if (!all_known || !(rates > 0)) return double(height) / (kFirstPart * count);
  return kShareTaken * (rows.bottom - rows.next) * (mine.rows / mine.milliseconds) / rates;
}

/// Renders bands on one device, in a thread of its own.
struct Worker {
  std::list<Sharer>& sharers;
  Sharer& mine;
  SharedRows& rows;
  int height;                     ///< of the picture
  std::optional<Band> band = {};  ///< the rest of the current band
  double begun = 0;
  Stats stats = {};
  std::uint64_t rows_made = 0;
  double milliseconds = 0;

  /// A NextBand. Waits while other devices may still return bands.
  std::optional<Band> nextBand(const BandLimits& limits) {
    std::unique_lock lock(rows.mutex);
    const auto isAhead = [&] { return rows.next - rows.taken > kMostAhead * limits.tallest; };
    rows.changed.wait(lock, [&] {
      return rows.failure || rows.taken == rows.bottom || !rows.returned.empty() ||
             (rows.next < rows.bottom && !isAhead());
    });
    if (rows.failure || rows.taken == rows.bottom) return std::nullopt;
    if (!rows.returned.empty()) {
      band = rows.returned.back();
      rows.returned.pop_back();
      // It may be taller than this device's memory allows.
      const int bottom = band->first + band->height;
      const int end = bandEnd(band->first, {limits.tallest, limits.origin, bottom});
      if (end < bottom) rows.returned.push_back({end, bottom - end});
      band->height = end - band->first;
    } else {
      const double wanted = wantedRows(sharers, mine, rows, height);
      const int most = std::clamp(int(wanted), std::min(kBinSize, limits.tallest), limits.tallest);
      band = Band{rows.next, bandEnd(rows.next, {most, limits.origin, rows.bottom}) - rows.next};
      rows.next += band->height;
    }
    begun = millisecondsSinceStart();
    return band;
  }

  /// A BandSink.
  void takeRows(const Band& made, const Image& image) {
    const double now = millisecondsSinceStart();
    const std::lock_guard lock(rows.mutex);
    mine.rows += made.height;
    mine.milliseconds += now - begun;
    rows_made += std::uint64_t(made.height);
    milliseconds += now - begun;
    begun = now;
    rows.done.emplace(made.first, image);
    band = Band{made.first + made.height, band->height - made.height};
    rows.changed.notify_all();
  }

  void run(const Scene& scene, const RenderSettings& settings, const PicturePlan& plan) {
    const TraceThread thread(mine.device->description.name.c_str());
    std::exception_ptr failure;
    std::string error;
    try {
      makeBands(
          *mine.device, scene, settings, plan, [&](const BandLimits& limits) { return nextBand(limits); },
          [&](const Band& made, const Image& image) { takeRows(made, image); }, stats, &mine.kept);
    } catch (const MachineError& problem) {
      failure = std::current_exception();
      error = problem.what();
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(rows.mutex);
    --rows.working;
    mine.error = error;
    if (band && band->height > 0) rows.returned.push_back(*band);
    // An empty message: the input is wrong, for every device.
    if (failure && (error.empty() || rows.working == 0)) rows.failure = failure;
    rows.changed.notify_all();
  }
};

/// Gives finished rows to `take`, from the top down, until all are taken.
void passFinishedRows(SharedRows& rows, int top, const RenderSettings& settings, const RowSink& take) {
  while (true) {
    Image image;
    {
      std::unique_lock lock(rows.mutex);
      if (rows.taken == rows.bottom) return;
      rows.changed.wait(lock, [&] { return rows.failure || rows.done.count(rows.taken) > 0; });
      if (rows.failure) std::rethrow_exception(rows.failure);
      image = std::move(rows.done.extract(rows.taken).mapped());
    }
    take(image);
    int taken = 0;
    {
      const std::lock_guard lock(rows.mutex);
      taken = rows.taken += image.height;
      rows.changed.notify_all();
    }
    if (settings.on_pass) settings.on_pass(taken - top, rows.bottom - top);
  }
}

/// Joins threads, also where an exception leaves.
struct Joiner {
  SharedRows& rows;
  std::vector<std::thread> threads = {};

  void join() {
    for (std::thread& thread : threads) thread.join();
    threads.clear();
  }
  ~Joiner() {
    {
      const std::lock_guard lock(rows.mutex);
      if (!threads.empty() && !rows.failure)
        rows.failure = std::make_exception_ptr(MachineError("left before its end"));
      rows.changed.notify_all();
    }
    join();
  }
};

}  // namespace

void renderShared(std::list<Sharer>& sharers, const Scene& scene, const RenderSettings& settings,
                  const RowSink& take, Stats& stats) {
  if (sharers.size() == 1) {
    Sharer& only = sharers.front();
    renderBands(*only.device, scene, settings, take, stats, &only.kept);
    return;
  }
  validate(scene, settings, &sharers.front().kept);
  const PicturePlan plan = planPicture(scene, settings);
  const int top = plan.view.crop_origin.y, bottom = top + plan.view.crop_size.y;
  SharedRows rows{bottom, top, top, 0};
  RenderSettings without_report = settings;
  without_report.on_pass = nullptr;
  without_report.on_long_compile = nullptr;
  std::list<Worker> workers;
  for (Sharer& sharer : sharers)
    if (sharer.error.empty()) workers.push_back({sharers, sharer, rows, plan.view.crop_size.y});
  if (workers.empty()) throw MachineError(sharers.front().error);
  rows.working = int(workers.size());
  Joiner joiner{rows};
  for (Worker& worker : workers)
    joiner.threads.emplace_back([&] { worker.run(scene, without_report, plan); });
  passFinishedRows(rows, top, settings, take);
  joiner.join();
  for (const Worker& worker : workers) {
    addPart(worker.stats, stats);
    stats.shares.push_back(
        {worker.mine.device->description, worker.rows_made, worker.milliseconds, worker.mine.error});
  }
}

}  // namespace luciole
