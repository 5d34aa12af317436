#pragma once

#include <memory>
#include <tuple>
#include <utility>

#include "run/measure/measurement.h"

namespace shaken::run {

/// A measurement whose state is that of `accumulators`: `sample`(sample, accumulators...) gives them a sample, and
/// `reduce`(result, accumulators...) what they found. Saved are the accumulators, one behind the other.
template <class TakeSample, class Reduce, class... Accumulators>
std::unique_ptr<Measurement> measured(TakeSample sample, Reduce reduce, Accumulators... accumulators) {
  class Measured final : public Measurement {
   public:
    Measured(TakeSample sample, Reduce reduce, Accumulators... accumulators)
        : sample_(std::move(sample)), reduce_(std::move(reduce)), accumulators_(std::move(accumulators)...) {}

    void sample(const Sample& sample) override {
      std::apply([&](auto&... each) { sample_(sample, each...); }, accumulators_);
    }
    void reduce(Reduction& result) const override {
      std::apply([&](const auto&... each) { reduce_(result, each...); }, accumulators_);
    }
    void save(StateWriter& writer) const override {
      std::apply([&](const auto&... each) { (each.save(writer), ...); }, accumulators_);
    }
    void restore(StateReader& reader) override {
      std::apply([&](auto&... each) { (each.restore(reader), ...); }, accumulators_);
    }

   private:
    TakeSample sample_;
    Reduce reduce_;
    std::tuple<Accumulators...> accumulators_;
  };
  return std::make_unique<Measured>(std::move(sample), std::move(reduce), std::move(accumulators)...);
}

}  // namespace shaken::run
