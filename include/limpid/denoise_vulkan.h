/* Limpid's denoisers inside a Vulkan program: they use its device and record into its command buffers.
 *
 * The device needs Vulkan 1.3 with the features synchronization2, maintenance4, scalarBlockLayout and
 * shaderStorageImageExtendedFormats; limpid_vulkan_enable_features() switches them on in a chain of yours. The queue
 * must compute. No function is linked: all are loaded through your vkGetInstanceProcAddr.
 *
 * Limpid never submits, waits or owns a queue. limpid_record() writes into a command buffer that is recording, outside
 * of a render pass. What it orders, exactly:
 * - Before its passes stands one vkCmdPipelineBarrier2. For each image, an image barrier from `stages_before` and
 *   `access_before` to the compute shader stage; sampled images stay in `layout`, outputs go into GENERAL. And a
 * memory barrier from compute shaders and copies to compute shaders and copies, which orders it behind the denoiser's
 * earlier frames in the same queue.
 * - After its passes stands one with an image barrier for each output, from the compute shader stage to `stages_after`
 *   and `access_after`, and from GENERAL into `layout_after`. Inputs may be overwritten by what waits for the compute
 *   shader stage.
 * - Queue ownership is not transferred. Frames of one denoiser must run in the order in which they were recorded.
 * - Compute and descriptor state of the command buffer (bound pipeline and sets of the compute bind point) is lost.
 * What a frame uses is used again `frames_in_flight` frames later: before you record frame n, frame n -
 * frames_in_flight must be done on the device. (Wait for its fence, as you do for your own resources.)
 */
#ifndef LIMPID_DENOISE_VULKAN_H
#define LIMPID_DENOISE_VULKAN_H

#include <limpid/denoise.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sets the needed flags in the chain that begins with `features` (VkPhysicalDeviceFeatures2, and behind it
 * VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features, or the structs of the single features).
 * LIMPID_ERROR_INVALID_ARGUMENT if the chain has no place for one of them; the message names it. */
LIMPID_API limpid_result limpid_vulkan_enable_features(VkPhysicalDeviceFeatures2* features);

/* A block of memory from an allocator of yours. */
typedef struct limpid_vulkan_memory {
    VkDeviceMemory memory;
    VkDeviceSize offset;
    void* mapped; /* where the host sees the block; NULL if it does not */
    void* handle; /* yours */
} limpid_vulkan_memory;

typedef struct limpid_vulkan_device_desc {
    size_t size;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family; /* that the command buffers are for */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    int32_t debug_utils; /* not 0: VK_EXT_debug_utils is enabled; objects and passes get names */
    limpid_message_callback message;
    void* message_user;
    /* Both or none. None: Limpid allocates one VkDeviceMemory for each of its some twenty images. `allocate` gives a
     * block of a memory type of `requirements` with all of `properties`; where these have the host-visible bit,
     * `mapped` must be set. */
    VkResult (*allocate)(void* user, const VkMemoryRequirements* requirements, VkMemoryPropertyFlags properties,
                         const char* name, limpid_vulkan_memory* block);
    void (*free)(void* user, const limpid_vulkan_memory* block);
    void* memory_user;
} limpid_vulkan_device_desc;

/* The instance and device outlive the limpid_device. Destroying the latter waits for nothing. */
LIMPID_API limpid_result limpid_device_adopt(const limpid_vulkan_device_desc* desc, limpid_device** device);

typedef struct limpid_vulkan_image {
    VkImage image;    /* VK_NULL_HANDLE: there is no such image */
    VkImageView view; /* two-dimensional, one level, one layer, identity swizzle; of width x height pixels */
    /* Inputs: any format that can be sampled (usage SAMPLED), floats or normalised; of LIMPID_INPUT_ID unsigned
     * integers. Outputs (usage STORAGE): VK_FORMAT_R16G16B16A16_SFLOAT or VK_FORMAT_R32G32B32A32_SFLOAT. */
    VkFormat format;
    /* Inputs: in which it is and stays; 0: VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL. Outputs: in which it is; 0:
     * VK_IMAGE_LAYOUT_UNDEFINED. */
    VkImageLayout layout;
    /* What wrote an input, or last used an output. 0 and 0: nothing to wait for (a barrier of yours, or a semaphore,
     * has ordered it). */
    VkPipelineStageFlags2 stages_before;
    VkAccessFlags2 access_before;
    /* Outputs only: what will use it, and in which layout; 0: VK_IMAGE_LAYOUT_GENERAL. */
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

/* Records one frame. On failure nothing that matters has been recorded; the command buffer may be submitted. A frame
 * that was recorded must run: if you drop its command buffer, destroy the denoiser. */
LIMPID_API limpid_result limpid_record(limpid_denoiser* denoiser, VkCommandBuffer commands,
                                       const limpid_vulkan_frame* frame);

/* Records all passes over a few pixels of the frame's inputs, for drivers that compile at the first dispatch (Mesa's
 * lavapipe): after they have run, no frame is slower than the others. Optional. Outputs are not touched, and the frame
 * does not count: the next one finds no history. */
LIMPID_API limpid_result limpid_warm_up(limpid_denoiser* denoiser, VkCommandBuffer commands,
                                        const limpid_vulkan_frame* frame);

#ifdef __cplusplus
}
#endif
#endif
