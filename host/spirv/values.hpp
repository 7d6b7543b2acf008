#pragma once

#include "host/spirv/grammar.hpp"
#include "host/spirv/module.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace stromboli::spirv {

enum class Kind : uint8_t { Other, Bool, Int32 };

/// Values of 32-bit integers and booleans by number, and what each number has been replaced by.
class Values {
  public:
    explicit Values(Module& module)
        : module_(module), replacedBy_(module.bound), known_(module.bound) {
        for (Instruction& i : module_.globals)
            enter(i);
    }

    /// Takes in a type or a constant; one that equals an earlier one is replaced by it.
    void enter(const Instruction& i) {
        if (i.op == OpTypeBool) kinds_[i.result] = Kind::Bool;
        if (i.op == OpTypeInt && module_.operands(i)[0] == 32) kinds_[i.result] = Kind::Int32;
        if (i.op == OpConstantTrue || i.op == OpConstantFalse)
            enter(i, i.op == OpConstantTrue ? 1u : 0u);
        if (i.op == OpConstant && kindOf(i.type) == Kind::Int32) enter(i, module_.operands(i)[0]);
    }

    Kind kindOf(uint32_t type) const {
        const auto found = kinds_.find(type);
        return found == kinds_.end() ? Kind::Other : found->second;
    }

    uint32_t resolve(uint32_t number) const {
        while (number < replacedBy_.size() && replacedBy_[number] != 0)
            number = replacedBy_[number];
        return number;
    }

    std::optional<uint32_t> valueOf(uint32_t number) const {
        if (number >= known_.size() || !known_[number].isKnown) return {};
        return known_[number].value;
    }

    void replace(uint32_t number, uint32_t by) {
        grow(number);
        if (number != by) replacedBy_[number] = by;
    }

    /// The number of a constant, which is made where there is none.
    uint32_t constant(uint32_t type, uint32_t value) {
        if (const auto found = constants_.find({type, value}); found != constants_.end())
            return found->second;
        const uint32_t number = module_.newNumber();
        Instruction i =
            kindOf(type) == Kind::Bool
                ? module_.make(value != 0 ? OpConstantTrue : OpConstantFalse, type, number, {})
                : module_.make(OpConstant, type, number, {&value, 1});
        module_.globals.push_back(i);
        enter(i, value);
        return number;
    }

  private:
    struct Known {
        bool isKnown = false;
        uint32_t value = 0;
    };

    void grow(uint32_t number) {
        if (number >= known_.size()) {
            known_.resize(module_.bound);
            replacedBy_.resize(module_.bound);
        }
    }

    void enter(const Instruction& i, uint32_t value) {
        grow(i.result);
        known_[i.result] = {true, value};
        const auto [at, isNew] = constants_.insert({{i.type, value}, i.result});
        if (!isNew) replace(i.result, at->second);
    }

    Module& module_;
    std::unordered_map<uint32_t, Kind> kinds_;
    std::vector<uint32_t> replacedBy_; ///< 0: by nothing
    std::vector<Known> known_;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> constants_;
};

/// Computes an operation whose operands are all known.
std::optional<uint32_t> computed(const Values& values, uint16_t op, uint32_t type,
                                 std::span<const uint32_t> operands);

} // namespace stromboli::spirv
