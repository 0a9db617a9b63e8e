// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/edge_support.hpp"

#include "graph_numbers.hpp"

namespace shapemap {

double EdgeSupport::value() const { return (for_it - against_it) / (for_it + against_it + kGraph.edge_support.little); }

}  // namespace shapemap
