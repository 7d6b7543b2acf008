#include "host/spirv/module.hpp"

#include <cstring>

namespace stromboli::spirv {
namespace {

constexpr uint32_t kMagic = 0x07230203, kHeaderWords = 5;

class Writer {
  public:
    explicit Writer(const Module& module)
        : module_(module), newNumber_(module.bound), global_(module.bound) {
        for (const Instruction& i : module_.globals)
            global_[i.result] = &i;
    }

    std::vector<uint32_t> write() {
        orderGlobals();
        code_ = {kMagic, module_.version, 0, 0, 0};
        for (const Instruction& i : module_.preamble)
            if (i.op == OpEntryPoint)
                writeEntryPoint(i);
            else
                writeInstruction(i);
        writeDecorations();
        for (const Instruction* i : ordered_)
            writeInstruction(*i);
        for (const Function& f : module_.functions) {
            writeInstruction(f.head);
            for (const Instruction& p : f.parameters)
                writeInstruction(p);
            for (const Block& b : f.blocks) {
                writeInstruction({.op = OpLabel, .result = b.label});
                for (const Instruction& i : b.body)
                    writeInstruction(i);
            }
            writeInstruction({.op = OpFunctionEnd});
        }
        code_[3] = next_;
        return std::move(code_);
    }

  private:
    /// Globals that something uses, each behind what it uses itself.
    void orderGlobals() {
        isOrdered_.resize(module_.bound);
        for (const Instruction& d : module_.decorations) {
            const auto operands = module_.operands(d);
            if (d.op == OpDecorate && operands.size() > 2 && operands[1] == kDecorationBuiltIn &&
                operands[2] == kBuiltInWorkgroupSize)
                order(operands[0]);
        }
        for (const Function& f : module_.functions) {
            orderUses(f.head);
            for (const Instruction& p : f.parameters)
                orderUses(p);
            for (const Block& b : f.blocks)
                for (const Instruction& i : b.body)
                    orderUses(i);
        }
    }

    void orderUses(const Instruction& i) {
        if (i.type != 0) order(i.type);
        forEachNumber(i, module_.operands(i), [&](uint32_t number) { order(number); });
    }

    void order(uint32_t number) {
        if (number >= global_.size() || global_[number] == nullptr || isOrdered_[number]) return;
        isOrdered_[number] = true;
        orderUses(*global_[number]);
        ordered_.push_back(global_[number]);
    }

    uint32_t renamed(uint32_t number) {
        uint32_t& now = newNumber_[number];
        if (now == 0) now = next_++;
        return now;
    }

    void begin(uint16_t op) {
        start_ = code_.size();
        code_.push_back(op);
    }
    void end() { code_[start_] |= uint32_t(code_.size() - start_) << 16; }

    void writeInstruction(const Instruction& i) {
        begin(i.op);
        if (i.type != 0) code_.push_back(renamed(i.type));
        if (i.result != 0) code_.push_back(renamed(i.result));
        const size_t first = code_.size();
        const auto operands = module_.operands(i);
        code_.insert(code_.end(), operands.begin(), operands.end());
        forEachNumber(i, std::span(code_).subspan(first),
                      [&](uint32_t& number) { number = renamed(number); });
        end();
    }

    /// Execution model, function, name, and those variables of the interface that are still there.
    void writeEntryPoint(const Instruction& i) {
        const auto operands = module_.operands(i);
        begin(i.op);
        code_.push_back(operands[0]);
        code_.push_back(renamed(operands[1]));
        size_t k = 2;
        for (bool isLast = false; !isLast && k < operands.size(); ++k) {
            code_.push_back(operands[k]);
            char characters[4];
            std::memcpy(characters, &operands[k], sizeof characters);
            isLast = std::memchr(characters, 0, sizeof characters) != nullptr;
        }
        std::vector<bool> isNamed(module_.bound);
        for (; k < operands.size(); ++k)
            isNamed[operands[k]] = true;
        for (const Instruction* g : ordered_)
            if (isNamed[g->result]) code_.push_back(renamed(g->result));
        end();
    }

    void writeDecorations() {
        std::unordered_map<uint32_t, std::vector<const Instruction*>> of;
        for (const Instruction& d : module_.decorations)
            of[module_.operands(d)[0]].push_back(&d);
        const auto writeFor = [&](uint32_t number) {
            const auto found = of.find(number);
            if (number == 0 || found == of.end()) return;
            for (const Instruction* d : found->second) {
                begin(d->op);
                const auto operands = module_.operands(*d);
                code_.push_back(renamed(operands[0]));
                code_.insert(code_.end(), operands.begin() + 1, operands.end());
                end();
            }
        };
        for (const Instruction* g : ordered_)
            writeFor(g->result);
        for (const Function& f : module_.functions)
            for (const Block& b : f.blocks)
                for (const Instruction& i : b.body)
                    writeFor(i.result);
    }

    const Module& module_;
    std::vector<uint32_t> newNumber_;
    std::vector<const Instruction*> global_; ///< by number
    std::vector<bool> isOrdered_;
    std::vector<const Instruction*> ordered_;
    std::vector<uint32_t> code_;
    size_t start_ = kHeaderWords;
    uint32_t next_ = 1;
};

} // namespace

std::vector<uint32_t> writeModule(const Module& module) {
    return Writer(module).write();
}

} // namespace stromboli::spirv
