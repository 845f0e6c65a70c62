#pragma once
#include "filter/atrous.h"
#include "filter/edge_avoiding.h"
#include "filter/temporal.h"
#include "reconstruct/module.h"

namespace lumi {

/// Rows of a Lineage for the stages that several modules share. Parts are normalised, so that those of a stage sum to
/// 1.

/// The stage `history`, or what it is called: this frame's sample and the taps of the frame before, those that were
/// refused with why. `previous` may be null or empty: there is no frame before, or none whose history was kept.
/// `dropped` as TemporalOptions has it. `loss`: lambda, how much of the history is given up.
void addHistoryRows(Lineage& lineage, const Signals& signals, const TemporalHistory* previous,
                    const TemporalSettings& settings, const Image* dropped = nullptr,
                    const std::string& stage = "history", const Image* loss = nullptr);

/// A level of SVGF's wavelet, of the component `illumination`, its input: eqs. 1 to 5.
void addAtrousRows(Lineage& lineage, const std::string& stage, const SurfaceGuide& guide,
                   const AtrousSettings& settings, const Illumination& illumination, int step);

/// A level (from 0) of the wavelet with fixed edges over `in`.
void addEdgeAvoidingRows(Lineage& lineage, const std::string& stage, const Signals& signals,
                         const EdgeAvoidingSettings& settings, int level, const Image& in);

}  // namespace lumi
