#include "host/spirv/module.hpp"

#include <cstring>

namespace stromboli::spirv {

// --- Modules -------------------------------------------------------------------------------------

namespace {

constexpr uint32_t kMagic = 0x07230203, kHeaderWords = 5;

bool isForDebuggers(uint16_t op) {
    return (OpSource - 1 <= op && op <= OpLine) || op == OpNoLine || op == OpModuleProcessed;
}

bool isPreamble(uint16_t op) {
    return op == OpCapability || op == OpExtension || op == OpExtInstImport ||
           op == OpMemoryModel || op == OpEntryPoint || op == OpExecutionMode;
}

/// Puts an instruction into the part of the module that it belongs to; false: it cannot stand here.
bool place(Module& module, const Instruction& i, bool& inFunction) {
    if (i.op == OpFunction) {
        if (inFunction) return false;
        module.functions.push_back({.head = i});
        inFunction = true;
    } else if (i.op == OpFunctionEnd) {
        if (!inFunction) return false;
        inFunction = false;
    } else if (inFunction) {
        Function& f = module.functions.back();
        if (i.op == OpLabel)
            f.blocks.push_back({.label = i.result});
        else if (i.op == OpFunctionParameter)
            f.parameters.push_back(i);
        else if (f.blocks.empty())
            return false;
        else
            f.blocks.back().body.push_back(i);
    } else if (isPreamble(i.op)) {
        module.preamble.push_back(i);
    } else if (i.op == OpDecorate || i.op == OpMemberDecorate) {
        module.decorations.push_back(i);
    } else {
        module.globals.push_back(i);
    }
    return true;
}

} // namespace

Instruction Module::make(uint16_t op, uint32_t type, uint32_t result,
                         std::span<const uint32_t> operands) {
    const Instruction i = {op, uint16_t(operands.size()), uint32_t(words.size()), type, result};
    words.insert(words.end(), operands.begin(), operands.end());
    return i;
}

std::optional<Module> readModule(std::span<const uint32_t> code) {
    if (code.size() < kHeaderWords || code[0] != kMagic) return {};
    Module module{.version = code[1], .bound = code[3]};
    // Passes append the operands of what they make.
    module.words.reserve(code.size() + code.size() / 4);
    module.words.assign(code.begin(), code.end());
    bool inFunction = false;
    for (size_t at = kHeaderWords; at < code.size();) {
        const uint16_t op = uint16_t(code[at] & 0xFFFF), length = uint16_t(code[at] >> 16);
        if (length == 0 || length > code.size() - at) return {};
        const size_t end = at + length;
        if (!isForDebuggers(op)) {
            const bool decorates = op == OpDecorate || op == OpMemberDecorate;
            const char* grammar = decorates ? "iL" : grammarOf(op);
            if (grammar == nullptr) return {};
            Instruction i = {.op = op};
            size_t next = at + 1;
            if (*grammar == 't') {
                if (next >= end) return {};
                i.type = code[next++];
                ++grammar;
            }
            if (*grammar == 'r') {
                if (next >= end) return {};
                i.result = code[next++];
            }
            i.at = uint32_t(next);
            i.count = uint16_t(end - next);
            if (i.type >= module.bound || i.result >= module.bound) return {};
            if (!place(module, i, inFunction)) return {};
        }
        at = end;
    }
    for (const Function& f : module.functions)
        for (const Block& b : f.blocks)
            if (b.body.empty() || !endsBlock(b.body.back().op)) return {};
    if (inFunction || module.functions.empty()) return {};
    return module;
}

// --- Writing a module ----------------------------------------------------------------------------

namespace {

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
