// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mapping_events.hpp"

namespace shapemap {

void EventFanOut::on_stage(std::string_view stage) {
  for (MappingEvents* listener : listeners_) listener->on_stage(stage);
}

void EventFanOut::on_progress(std::size_t done, std::size_t total) {
  for (MappingEvents* listener : listeners_) listener->on_progress(done, total);
}

void EventFanOut::on_warning(std::string_view message) {
  for (MappingEvents* listener : listeners_) listener->on_warning(message);
}

bool EventFanOut::keep_going() {
  bool all_go_on = true;
  for (MappingEvents* listener : listeners_) all_go_on = listener->keep_going() && all_go_on;
  return all_go_on;
}

void EventFanOut::on_shape(std::size_t scan_index, const std::vector<ShapePoint>& points) {
  for (MappingEvents* listener : listeners_) listener->on_shape(scan_index, points);
}

void EventFanOut::on_alignment(const TracedAlignment& alignment) {
  for (MappingEvents* listener : listeners_) listener->on_alignment(alignment);
}

void EventFanOut::on_scan(const ScanUpdate& scan) {
  for (MappingEvents* listener : listeners_) listener->on_scan(scan);
}

void EventFanOut::on_edge(const EdgeFound& edge) {
  for (MappingEvents* listener : listeners_) listener->on_edge(edge);
}

void EventFanOut::on_loop(const LoopJudged& loop) {
  for (MappingEvents* listener : listeners_) listener->on_loop(loop);
}

void EventFanOut::on_culled(const KeyframesCulled& culled) {
  for (MappingEvents* listener : listeners_) listener->on_culled(culled);
}

void EventFanOut::on_localization(const RobotLocalized& localized) {
  for (MappingEvents* listener : listeners_) listener->on_localization(localized);
}

void EventFanOut::on_map(const Map& map) {
  for (MappingEvents* listener : listeners_) listener->on_map(map);
}

void EventFanOut::on_edge_verified(const EdgeVerified& edge) {
  for (MappingEvents* listener : listeners_) listener->on_edge_verified(edge);
}

void EventFanOut::on_edge_chosen(const EdgeChosen& edge) {
  for (MappingEvents* listener : listeners_) listener->on_edge_chosen(edge);
}

}  // namespace shapemap
