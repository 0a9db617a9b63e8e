// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mapper.hpp"

#include <mutex>
#include <stdexcept>
#include <utility>

#include "back_end_thread.hpp"
#include "map_snapshot.hpp"
#include "odometry_trail.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

/// Keeps the latest map and the versions of changes. All functions are safe to call from any thread.
class Published {
 public:
  /// Gives the map the next version, and returns it.
  std::shared_ptr<const Map> add(Map map) {
    const std::lock_guard<std::mutex> lock(mutex_);
    map.version = latest_ ? latest_->version + 1 : 1;
    changed_.resize(map.scans.size(), 0);
    for (std::size_t i = 0; i < map.scans.size(); ++i) {
      const ScanPose before = latest_ && i < latest_->scans.size() ? latest_->scans[i] : ScanPose{};
      if (map.scans[i] != before) changed_[i] = map.version;
    }
    latest_ = std::make_shared<const Map>(std::move(map));
    return latest_;
  }

  std::shared_ptr<const Map> latest() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return latest_;
  }

  Corrections since(MapVersion version) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    Corrections result;
    if (!latest_) return result;
    result.version = latest_->version;
    for (std::size_t i = 0; i < changed_.size(); ++i) {
      if (changed_[i] > version) result.corrections.push_back({i, latest_->scans[i]});
    }
    return result;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Map> latest_;
  std::vector<MapVersion> changed_;  ///< for each scan, the last version in which it has moved
};

void require_plausible(const Scan& scan, std::size_t number) {
  const std::string fault = implausibility(scan);
  if (!fault.empty()) throw InputError("scan " + std::to_string(number) + ": " + fault);
}

}  // namespace

class Mapper::Implementation {
 public:
  Implementation(const MappingOptions& options, const LiveOptions& live, MappingEvents* events, MatchCache* cache)
      : options_(options),
        events_(events ? *events : nobody_),
        front_end_(options_, cache),
        trail_(options_.robust.matcher.confidence) {
    BackEndContext context{options_, events_, cache, {}};
    if (live.publish) context.publish = [this](Map map) { publish(std::move(map)); };
    if (live.in_background) {
      thread_ = std::make_unique<BackEndThread>(std::move(context), events_);
    } else {
      events_.hand_back();
      back_end_ = std::make_unique<BackEnd>(std::move(context));
    }
  }

  std::vector<ScanUpdate> add_scans(const Scan* first, std::size_t count, std::size_t session) {
    require_usable();
    std::vector<IncomingScan> scans;
    for (std::size_t i = 0; i < count; ++i) {
      require_plausible(first[i], front_end_.num_scans() + i);
      scans.push_back({first[i], session});
    }
    is_usable_ = false;  // should anything throw from here on, the parts of the mapper no longer fit each other
    std::vector<ScanUpdate> updates;
    for (TrackedScan& scan : front_end_.track(scans)) {
      events_.on_shape(scan.scan_index, scan.view->points);
      updates.push_back(trail_.add(scan, published_.latest().get()));
      events_.on_scan(updates.back());
      thread_ ? thread_->add(std::move(scan)) : back_end_->add(std::move(scan));
    }
    is_usable_ = true;
    return updates;
  }

  MapResult finish() {
    require_usable();
    is_usable_ = false;
    MapResult result = thread_ ? thread_->finish() : back_end_->finish();
    result.times.shape_s += front_end_.shape_s();
    result.times.align_s += front_end_.match_s();
    result.largest_component = largest_component(result.components);
    publish(map_snapshot(result));
    return result;
  }

  const Published& published() const { return published_; }

 private:
  void require_usable() const {
    if (!is_usable_) throw std::logic_error("the mapper has finished its map, or an exception has ended it");
  }

  void publish(Map map) { events_.on_map(*published_.add(std::move(map))); }

  MappingOptions options_;
  MappingEvents nobody_;
  BackgroundEvents events_;
  FrontEnd front_end_;
  OdometryTrail trail_;
  Published published_;
  bool is_usable_ = true;
  std::unique_ptr<BackEnd> back_end_;
  std::unique_ptr<BackEndThread> thread_;  ///< the last member, because the thread uses the others until it ends
};

Mapper::Mapper(const MappingOptions& options, const LiveOptions& live, MappingEvents* events, MatchCache* cache) {
  validate_all(options);
  implementation_ = std::make_unique<Implementation>(options, live, events, cache);
}

Mapper::~Mapper() = default;

ScanUpdate Mapper::add_scan(const Scan& scan, std::size_t session) {
  return implementation_->add_scans(&scan, 1, session).front();
}

std::vector<ScanUpdate> Mapper::add_scans(const Scan* first, std::size_t count, std::size_t session) {
  return implementation_->add_scans(first, count, session);
}

std::shared_ptr<const Map> Mapper::map() const { return implementation_->published().latest(); }

Corrections Mapper::corrections_since(MapVersion version) const { return implementation_->published().since(version); }

MapResult Mapper::finish() { return implementation_->finish(); }

}  // namespace shapemap
