/* Limpid's denoisers inside a Vulkan program: they use its device and record into its command buffers.
 *
 * The device needs Vulkan 1.3 with the features synchronization2, maintenance4, scalarBlockLayout and
 * shaderStorageImageExtendedFormats; limpid_vulkan_enable_features() enables them in your feature chain. The instance
 * must have been created with VkApplicationInfo::apiVersion 1.3 or later. The queue must support compute. No Vulkan
 * function is linked: all are loaded through your vkGetInstanceProcAddr.
 *
 * Limpid never submits, waits or owns a queue. limpid_record() writes into a command buffer that is being recorded,
 * outside of a render pass. Its synchronisation in detail:
 * - Before its passes, one vkCmdPipelineBarrier2 contains an image barrier for each image that a pass uses (inputs
 *   that the method does not read have none), from `stages_before` and `access_before` to the compute shader stage;
 *   sampled images stay in `layout`, outputs change to GENERAL. It also contains a memory barrier from compute shaders
 *   and copies to compute shaders and copies, which orders the frame after the denoiser's earlier frames on the same
 *   queue.
 * - After its passes, another one contains an image barrier for each output, from the compute shader stage to
 *   `stages_after` and `access_after`, and from GENERAL to `layout_after`. Inputs may be overwritten by commands that
 *   wait for the compute shader stage.
 * - Queue ownership is not transferred. Frames of one denoiser must run in the order in which they were recorded.
 * - The command buffer's compute state (pipeline and descriptor sets of the compute bind point) is lost.
 * A frame's resources are reused `frames_in_flight` frames later: before you record frame n, frame n -
 * frames_in_flight must be finished on the device. (Wait for its fence, as you do for your own resources.) Frames
 * that failed do not count.
 */
#ifndef LIMPID_DENOISE_VULKAN_H
#define LIMPID_DENOISE_VULKAN_H

#include <limpid/denoise.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sets the required flags in the chain that begins with `features` (VkPhysicalDeviceFeatures2, followed by
 * VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features, or the structs of the single features).
 * Returns LIMPID_ERROR_INVALID_ARGUMENT if the chain lacks the struct for a flag; the message names it. */
LIMPID_API limpid_result limpid_vulkan_enable_features(VkPhysicalDeviceFeatures2* features);

/* A block of memory from your own allocator. */
typedef struct limpid_vulkan_memory {
    VkDeviceMemory memory;
    VkDeviceSize offset;
    void* mapped; /* host address of the block; NULL if not host-visible */
    void* handle; /* your own value */
} limpid_vulkan_memory;

typedef struct limpid_vulkan_device_desc {
    size_t size;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family; /* of the command buffers; it must compute */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    int32_t debug_utils;             /* not 0: VK_EXT_debug_utils is enabled; objects and passes get names */
    limpid_message_callback message; /* reserved: it is not called yet; your own messenger hears of Limpid's calls */
    void* message_user;
    /* Set both or none. None: Limpid allocates one VkDeviceMemory for each of its twenty to sixty images. `allocate`
     * returns a block of a memory type allowed by `requirements` that has all of `properties`; if these include the
     * host-visible bit, it must set `mapped`, and the host-coherent bit is among them. Blocks hold buffers or
     * optimally tiled images, and you are not told which: if they share a VkDeviceMemory, align and pad them to
     * bufferImageGranularity. */
    VkResult (*allocate)(void* user, const VkMemoryRequirements* requirements, VkMemoryPropertyFlags properties,
                         const char* name, limpid_vulkan_memory* block);
    void (*free)(void* user, const limpid_vulkan_memory* block);
    void* memory_user;
} limpid_vulkan_device_desc;

/* The instance and device must outlive the limpid_device. Destroying that does not wait for anything. `*device` is
 * NULL on failure. LIMPID_ERROR_UNSUPPORTED: a feature or function is missing, or one of what all devices are asked
 * for: a queue family with compute and timestamps (not necessarily yours), and storage images and storage texel
 * buffers of the formats that Limpid uses. LIMPID_ERROR_INVALID_ARGUMENT: a member is not set, or the queue family
 * does not exist or compute. */
LIMPID_API limpid_result limpid_device_adopt(const limpid_vulkan_device_desc* desc, limpid_device** device);

typedef struct limpid_vulkan_image {
    VkImage image;    /* VK_NULL_HANDLE: the image is missing */
    VkImageView view; /* two-dimensional, one level, one layer, identity swizzle; of width x height pixels */
    /* Inputs: any format that can be sampled (usage SAMPLED), float or normalised; unsigned integers for
     * LIMPID_INPUT_ID (a stencil aspect, too). Outputs (usage STORAGE): VK_FORMAT_R16G16B16A16_SFLOAT or
     * VK_FORMAT_R32G32B32A32_SFLOAT. Must be set. */
    VkFormat format;
    /* Inputs: the layout, which does not change; 0: VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL. Outputs: the layout
     * before; 0: VK_IMAGE_LAYOUT_UNDEFINED. Images with depth and stencil: both aspects are in it, unless it is a
     * layout of one aspect, such as VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL; then the barrier covers that one. */
    VkImageLayout layout;
    /* The stages and accesses that wrote an input, or last used an output. 0 and 0: nothing to wait for (your own
     * barrier or semaphore has ordered it). */
    VkPipelineStageFlags2 stages_before;
    VkAccessFlags2 access_before;
    /* Outputs only: the next stages, accesses and layout that use it; 0: VK_IMAGE_LAYOUT_GENERAL. */
    VkImageLayout layout_after;
    VkPipelineStageFlags2 stages_after;
    VkAccessFlags2 access_after;
} limpid_vulkan_image;

typedef struct limpid_vulkan_frame {
    size_t size;
    limpid_vulkan_image inputs[LIMPID_INPUT_MAX];
    limpid_vulkan_image outputs[LIMPID_OUTPUT_MAX];
    limpid_camera camera;
    int32_t reset; /* not 0: a cut; history starts with this frame */
} limpid_vulkan_frame;

/* Records one frame. LIMPID_ERROR_INVALID_ARGUMENT: an input is missing or its format is not set or not of the right
 * kind, the method does not have a requested output, an output's format is another one, an output has the image of
 * an input or of another output, or what is read of the camera is not as limpid_camera says.
 * LIMPID_ERROR_OUT_OF_MEMORY, LIMPID_ERROR_DEVICE_LOST. After a failure the command buffer may still be submitted:
 * Limpid has added nothing of effect, and history does not advance; only a cut (`reset`) stays in effect. After
 * OUT_OF_MEMORY you may go on with the size of the last frame that succeeded, or a smaller one. Images of that frame's
 * size are kept, since it may still be running: if there is no memory for them beside those of a new size, wait for
 * your frames, destroy the denoiser and create another one. A recorded frame must run: if you drop its command buffer,
 * destroy the denoiser. */
LIMPID_API limpid_result limpid_record(limpid_denoiser* denoiser, VkCommandBuffer commands,
                                       const limpid_vulkan_frame* frame);

/* Records all passes for a few pixels of the frame's inputs, and clears the denoiser's images if no frame has used
 * them yet. For drivers that compile at the first dispatch and give memory when it is first written (Mesa's lavapipe),
 * so that the first frame is not slower than later ones. Optional. Outputs are not written, and history stays as it
 * is. The previous matrices are not read. The command buffer must run on the same queue before that of the next frame.
 * Each call takes a little memory that limpid_denoiser_destroy() frees, since it may still be executing: call it
 * once, and again after a change of size, but not for every frame. */
LIMPID_API limpid_result limpid_warm_up(limpid_denoiser* denoiser, VkCommandBuffer commands,
                                        const limpid_vulkan_frame* frame);

#ifdef __cplusplus
}
#endif
#endif
