#pragma once

#include "stromboli/stromboli.h"

#include "host/api/named_settings.hpp"
#include "host/api/picture_session.hpp"
#include "host/api/scene_maker.hpp"

#include <deque>
#include <memory>
#include <string>
#include <vector>

// What the pointers of the C API lead to.

struct stromboli_scene {
    std::shared_ptr<const stromboli::Scene> scene;
    std::vector<std::string> report;
};

struct stromboli_maker {
    stromboli::api::SceneMaker maker;
};

struct stromboli_session {
    stromboli::api::PictureSession session;
    stromboli::api::PictureSettings settings;
    stromboli_progress progress = nullptr;
    void* user = nullptr;
    std::deque<stromboli::api::Message> messages;
};
