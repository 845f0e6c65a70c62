#pragma once
#include <embree3/rtcore.h>

#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "math/vector.h"
#include "scene/posed_scene.h"

namespace lumi {

class RayRecorder;
struct BatchRay;

/// The Embree side of a posed scene. The top-level scene's geometry ids are instance indices:
///   rigid meshes that are placed once and never move: world-space triangles of the top level;
///   meshes that are shared or move: Embree instances of a scene a mesh, built once;
///   deforming meshes: Embree instances of a scene of their own, rebuilt for each pose;
///   light bodies (rectangle, disk, sphere): exact geometry, in a scene of their own if they move.
/// What moves while the shutter is open has several time steps, straight between them; rays say when they fly.
/// Scenes are built robust (no leaks at shared edges) at medium quality. Rebuilding rather than refitting keeps a frame
/// independent of the frames before it.
///
/// Alpha: filter functions reject hits on masked texels, and on blended ones with probability 1 - alpha by a hash of
/// the ray's id, the instance and the primitive.
///
/// Camera rays (kFromCamera in the ray's flags) pass the back faces of single-sided opaque materials: the filter of a
/// Context rejects those hits. It costs all others nothing.
class EmbreeScene {
public:
    static constexpr unsigned kFromCamera = 1;
    /// What a call of Embree for rays of this scene takes.
    struct Context : RTCIntersectContext {
        Context(const EmbreeScene& of, std::span<const BatchRay> rays);
        const EmbreeScene* scene;
    };

    EmbreeScene();
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// Builds what `posed` needs and keeps what did not change since the last call. `posed` must outlive the tracing,
    /// and the next call: what changed is found by comparing the two. Returns true if attachments were made anew:
    /// worldPositions() are others then. Throws Error(Resources) if Embree runs out of memory or past the limit, and
    /// Error(Interrupted) once `stop` is requested, which is looked at between instances and within builds; the scene
    /// is empty then. `progress` (may be empty) is called with the part of each of Embree's builds that is done, from
    /// any of its threads at a time.
    bool bind(const PosedScene& posed, std::stop_token stop = {}, const std::function<void(double)>& progress = {});

    RTCScene handle() const { return top_; }
    /// World-space vertices of an instance that was attached as triangles; null for all others.
    const Vec3* worldPositions(uint32_t instance) const;
    /// Are the vertices of an instance that moves carried into the world? See carried_steps.h.
    bool isCarried(uint32_t instance) const;
    /// Widest packet the device traces natively: 16, 8, 4 or 1.
    int packetWidth() const { return packetWidth_; }
    /// In what packets rays that go anywhere are fastest: the widest in small scenes, whose few nodes most rays meet
    /// alike, else 1.
    int strayPacketWidth() const { return strayPacketWidth_; }
    /// World space; of all that is bound, over the open shutter.
    const Bounds3& bounds() const { return bounds_; }
    size_t byteCount() const;

    /// Every ray traced from now on goes to `recorder` too; null: to none.
    void record(RayRecorder* recorder) { recorder_ = recorder; }
    RayRecorder* recorder() const { return recorder_; }

private:
    enum class Mode : uint8_t { None, Direct, Instanced, Deforming, Body, MovingBody };
    struct Plan;
    struct Attachment;
    struct MeshScene;
    struct Monitor;
    struct Body;

    void clear();
    /// `before` is what is bound, null if nothing is.
    std::vector<Plan> makePlans(const PosedScene& posed, const PosedScene* before) const;
    static bool sameAttachments(const PosedScene& a, const std::vector<Plan>& plansA, const PosedScene& b,
                                const std::vector<Plan>& plansB);
    void rebuild(const PosedScene& posed, std::vector<Plan> plans);
    void update(const PosedScene& posed, const PosedScene& before, std::vector<Plan> plans);
    void attachAll(const PosedScene& posed);
    RTCScene newScene() const;
    /// Triangles with vertices for each of equally spaced moments of the open shutter, which `place` writes.
    RTCGeometry newTriangles(unsigned steps, size_t vertexCount, const Mesh& mesh, bool filtered,
                             const std::function<void(unsigned step, Vec3* vertices)>& place) const;
    /// At rest, in its own space or in that of `transform`.
    RTCGeometry newMesh(const Mesh& mesh, bool filtered, const Mat4* transform) const;
    RTCGeometry newDeforming(const PosedScene& posed, uint32_t index, const Plan& plan) const;
    RTCGeometry newBody(const PosedScene& posed, uint32_t index) const;
    /// `meshScene` is that of the instance's mesh if it is Instanced.
    void makeAttachment(const PosedScene& posed, uint32_t index, RTCScene meshScene);
    void throwIfFailed(const char* step) const;
    void throwIfStopped() const;
    static void filter(const RTCFilterFunctionNArguments* arguments);
    /// Leaves of a parallelogram the ellipse in it: an elliptic or moving disk.
    static void filterCorners(const RTCFilterFunctionNArguments* arguments);
    static void filterBackFaces(const RTCFilterFunctionNArguments* arguments);
    void findSides(const PosedScene& posed);

    RTCDevice device_ = nullptr;
    RTCScene top_ = nullptr;
    int packetWidth_ = 1, strayPacketWidth_ = 1;
    Bounds3 bounds_;
    const PosedScene* posed_ = nullptr;  ///< null while the scene is empty
    /// Of each instance: has it a surface whose back the camera does not see, does Embree see its faces turned round,
    /// and if not so all the time while the shutter is open, ShutterTrack says when?
    struct Sides {
        bool single = false, turned = false, turnsOver = false;
    };
    std::vector<Sides> sides_;
    bool hidesBackFaces_ = false;
    RayRecorder* recorder_ = nullptr;
    std::unique_ptr<Monitor> monitor_;
    std::vector<Plan> plans_;
    std::vector<Attachment> attachments_;
    std::vector<MeshScene> meshScenes_;
};

}  // namespace lumi
