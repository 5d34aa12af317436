#include "client/watch/rod_cells.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "client/watch/rod_samples.h"

namespace shaken::client {
namespace {

constexpr Ink kMarkInk = 0xFFFFFF;
constexpr Ink kMarkBack = 0x000000;

/// What several samples have in common.
struct Blend {
  Tone tone = kFloorTone;  ///< that of most of those that are something
  int n_filled = 0;
  int n_in_box = 0;
};

Blend blended(const RodSamples& samples, int column, int row, int columns, int rows) {
  Blend blend;
  std::array<Tone, 8> seen{};
  std::size_t n_seen = 0;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      if (!samples.is_in_box(column + i, row + j)) continue;
      ++blend.n_in_box;
      if (const Tone tone = samples.tone(column + i, row + j); tone != kFloorTone) seen[n_seen++] = tone;
    }
  }
  const std::span filled(seen.data(), n_seen);
  std::ptrdiff_t most = 0;
  for (const Tone tone : filled) {
    if (const auto n = std::count(filled.begin(), filled.end(), tone); n > most) {
      most = n;
      blend.tone = tone;
    }
  }
  blend.n_filled = static_cast<int>(n_seen);
  return blend;
}

/// The colour of half a cell; the terminal's own outside the box.
Ink half_ink(const Blend& blend, bool mixes) {
  if (blend.n_in_box == 0) return kOwnInk;
  if (!mixes) return 2 * blend.n_filled >= blend.n_in_box ? ink_of(blend.tone) : ink_of(kFloorTone);
  return ink_of(blend.tone, static_cast<double>(blend.n_filled) / blend.n_in_box);
}

ScreenCell block_cell(const RodSamples& samples, int column, int row, bool mixes) {
  const Ink upper = half_ink(blended(samples, column, row, 2, 2), mixes);
  const Ink lower = half_ink(blended(samples, column, row + 2, 2, 2), mixes);
  if (upper == lower) return {.back = upper};
  if (upper == kOwnInk) return {.glyph = U'▄', .fore = lower};
  return {.glyph = U'▀', .fore = upper, .back = lower};
}

ScreenCell braille_cell(const RodSamples& samples, int column, int row, bool in_colour) {
  const Blend blend = blended(samples, column, row, 2, 4);
  ScreenCell cell;
  if (in_colour && blend.n_in_box > 0) cell.back = ink_of(kFloorTone);
  std::uint8_t bits = 0;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 2; ++i) {
      const bool is_set = samples.is_in_box(column + i, row + j) && samples.tone(column + i, row + j) != kFloorTone;
      if (is_set) bits |= kBrailleDots[j][i];
    }
  }
  if (bits == 0) return cell;
  cell.glyph = kNoDots + bits;
  if (in_colour) cell.fore = ink_of(blend.tone);
  return cell;
}

}  // namespace

void draw_rods(const RodFrame& frame, const std::vector<DefectMark>& defects, const RodView& view,
               const RodStyle& style, const Area& area, CellGrid& grid) {
  const RodSamples samples(frame, view, style.colouring, 2 * area.columns, 4 * area.lines);
  const bool has_blocks = style.in_colour && style.grain == Grain::kBlocks;
  for (int line = 0; line < area.lines; ++line) {
    for (int column = 0; column < area.columns; ++column) {
      grid.at(area.column + column, area.line + line) =
          has_blocks ? block_cell(samples, 2 * column, 4 * line, style.mixes)
                     : braille_cell(samples, 2 * column, 4 * line, style.in_colour);
    }
  }
  if (style.shows_defects) mark_defects(samples, defects, style, area, grid);
}

void mark_defects(const RodSamples& samples, const std::vector<DefectMark>& defects, const RodStyle& style,
                  const Area& area, CellGrid& grid) {
  for (const DefectMark& defect : defects) {
    const auto [column, row] = samples.place(defect.x, defect.y);
    if (!samples.is_in_box(column, row)) continue;
    ScreenCell& cell = grid.at(area.column + column / 2, area.line + row / 4);
    cell = {.glyph = defect.is_positive ? U'+' : U'−', .bold = true};
    if (style.in_colour) {
      cell.fore = defect.is_positive ? kMarkBack : kMarkInk;
      cell.back = defect.is_positive ? kMarkInk : kMarkBack;
    }
  }
}

}  // namespace shaken::client
