# SPDX-License-Identifier: GPL-3.0-or-later
"""The arena's floor plan: a maze of square cells, opened up in places, and a long route through it.

Cells are `(column, row)`. An opening is a pair of neighbouring cells in sorted order with no wall between them.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np

from evaluation.common.poses import Array

Cell = tuple[int, int]
Opening = tuple[Cell, Cell]


@dataclass(frozen=True)
class MazeOptions:
    """Plan of the arena; lengths in metres. `missing_wall_share` of the maze's walls are
    taken out; `doorway_share` of the sides of its openings have a short panel; `winding` 0 makes straight routes."""

    columns: int = 13
    rows: int = 8
    cell_m: float = 1.2
    missing_wall_share: float = 0.25
    doorway_share: float = 0.6
    num_halls: int = 3
    corridor_cells: int = 6
    winding: float = 1.0
    route_jitter_m: float = 0.06


def opening(a: Cell, b: Cell) -> Opening:
    return (a, b) if a <= b else (b, a)


def neighbours(cell: Cell, options: MazeOptions) -> list[Cell]:
    x, y = cell
    around = [(x + 1, y), (x, y + 1), (x - 1, y), (x, y - 1)]
    return [c for c in around if 0 <= c[0] < options.columns and 0 <= c[1] < options.rows]


def all_edges(options: MazeOptions) -> list[Opening]:
    """Every pair of neighbouring cells, in a fixed order."""
    cells = [(x, y) for x in range(options.columns) for y in range(options.rows)]
    return [(c, n) for c in cells for n in neighbours(c, options) if c < n]


def carve_tree(options: MazeOptions, rng: np.random.Generator) -> set[Opening]:
    """Openings that connect all cells without a loop, by a random depth-first walk."""
    start = (int(rng.integers(options.columns)), int(rng.integers(options.rows)))
    seen, stack, openings = {start}, [start], set()
    while stack:
        fresh = [c for c in neighbours(stack[-1], options) if c not in seen]
        if not fresh:
            stack.pop()
            continue
        chosen = fresh[int(rng.integers(len(fresh)))]
        openings.add(opening(stack[-1], chosen))
        seen.add(chosen)
        stack.append(chosen)
    return openings


def open_halls(openings: set[Opening], options: MazeOptions, rng: np.random.Generator) -> None:
    """Take out all walls inside a few rectangles of 2 x 2 to 3 x 3 cells."""
    for _ in range(options.num_halls):
        width, height = (int(n) for n in rng.integers(2, 4, size=2))
        x0 = int(rng.integers(options.columns - width + 1))
        y0 = int(rng.integers(options.rows - height + 1))
        inside = {(x, y) for x in range(x0, x0 + width) for y in range(y0, y0 + height)}
        openings.update(edge for edge in all_edges(options) if edge[0] in inside and edge[1] in inside)


def open_corridor(openings: set[Opening], options: MazeOptions, rng: np.random.Generator) -> None:
    """One straight corridor: no cross walls along it, most of its side walls in place."""
    cells = min(options.corridor_cells, options.columns)
    x0 = int(rng.integers(options.columns - cells + 1))
    y0 = int(rng.integers(1, options.rows - 1))
    for x in range(x0, x0 + cells - 1):
        openings.add(((x, y0), (x + 1, y0)))


def plan_openings(options: MazeOptions, rng: np.random.Generator) -> set[Opening]:
    """The whole plan: a maze with some walls missing, a few open areas and a corridor."""
    openings = carve_tree(options, rng)
    edges = all_edges(options)
    missing = rng.random(len(edges)) < options.missing_wall_share
    openings.update(edge for edge, gone in zip(edges, missing) if gone)
    open_halls(openings, options, rng)
    open_corridor(openings, options, rng)
    return openings


def cheapest_path(
    start: Cell, goal: Cell, openings: set[Opening], costs: dict[Cell, float], options: MazeOptions
) -> list[Cell]:
    """Dijkstra's path from start to goal; entering a cell costs `costs[cell]`."""
    queue, came_from, spent = [(0.0, start)], {start: start}, {start: 0.0}
    while queue:
        so_far, cell = heapq.heappop(queue)
        if cell == goal:
            break
        for following in neighbours(cell, options):
            total = so_far + costs[following]
            if opening(cell, following) in openings and total < spent.get(following, np.inf):
                spent[following], came_from[following] = total, cell
                heapq.heappush(queue, (total, following))
    path = [goal]
    while path[-1] != start:
        path.append(came_from[path[-1]])
    return path[::-1]


def plan_route(openings: set[Opening], options: MazeOptions, rng: np.random.Generator) -> list[Cell]:
    """A tour around the hall and back through its middle; cells already driven are avoided where possible."""
    right, top = options.columns - 1, options.rows - 1
    stops = np.array([[1, 1], [right - 1, 1], [right - 1, top - 1], [1, top - 1], [1, top // 2], [right - 2, top // 2]])
    stops = stops + rng.integers(-1, 2, size=stops.shape)
    if rng.random() < 0.5:
        stops[:, 0] = right - stops[:, 0]
    if rng.random() < 0.5:
        stops[:, 1] = top - stops[:, 1]
    stops = np.clip(stops, 0, [right, top])
    costs = {(x, y): 1.0 + options.winding * rng.random() for x in range(right + 1) for y in range(top + 1)}
    route = [(int(stops[0][0]), int(stops[0][1]))]
    for stop in stops[1:]:
        leg = cheapest_path(route[-1], (int(stop[0]), int(stop[1])), openings, costs, options)
        for cell in leg:
            costs[cell] += 2.0
        route.extend(leg[1:])
    return without_spurs(route)


def without_spurs(route: list[Cell]) -> list[Cell]:
    """The route less its trips into a dead end and back."""
    kept: list[Cell] = []
    for cell in route:
        if len(kept) >= 2 and kept[-2] == cell:
            kept.pop()
        else:
            kept.append(cell)
    return kept


def cell_centres(cells: list[Cell], options: MazeOptions) -> Array:
    """Centres `[n, 2]` in the map frame."""
    return (np.array(cells, dtype=float) + 0.5) * options.cell_m


def edge_panel(edge: Opening) -> Array:
    """Ends `[2, 2]`, in cells, of the panel that would part two neighbouring cells."""
    (ax, _), (bx, by) = edge
    corner = np.array([bx, by], dtype=float)
    return np.stack([corner, corner + (np.array([0.0, 1.0]) if bx > ax else np.array([1.0, 0.0]))])


def wall_panels(openings: set[Opening], options: MazeOptions) -> Array:
    """Ends `[n, 2, 2]` of the panel between each two cells that have a wall."""
    panels = [edge_panel(edge) for edge in all_edges(options) if edge not in openings]
    return np.array(panels).reshape(-1, 2, 2) * options.cell_m


def doorway_panels(openings: set[Opening], options: MazeOptions, rng: np.random.Generator) -> Array:
    """Ends `[n, 2, 2]` of the short panels that narrow an opening from one side or from both."""
    panels = []
    for edge in (edge for edge in all_edges(options) if edge in openings):
        low, high = edge_panel(edge)
        widths = rng.uniform(0.15, 0.28, size=2)
        for post, inwards, width in ((low, high - low, widths[0]), (high, low - high, widths[1])):
            if rng.random() < options.doorway_share:
                panels.append([post, post + width * inwards])
    return np.array(panels).reshape(-1, 2, 2) * options.cell_m


def outer_panels(options: MazeOptions, num_doors: int, rng: np.random.Generator) -> Array:
    """Ends `[n, 2, 2]` of the panels around the hall, less a few doors to the outside."""
    columns, rows = options.columns, options.rows
    low = [[(x, 0), (x + 1, 0)] for x in range(columns)] + [[(0, y), (0, y + 1)] for y in range(rows)]
    high = [[(x, rows), (x + 1, rows)] for x in range(columns)]
    high += [[(columns, y), (columns, y + 1)] for y in range(rows)]
    panels = np.array(low + high, dtype=float)
    doors = rng.choice(len(panels), size=num_doors, replace=False)
    return np.delete(panels, doors, axis=0) * options.cell_m
