"""How images reach other libraries of arrays. Needs NumPy; PyTorch and CuPy are used where they are installed.

    python3 share_memory.py
"""
import numpy as np

import skiagraph as sk

scene = sk.Scene()
scene.add("ball", sk.Mesh.sphere(40, 64), material="water")
scene.view = sk.View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(2, 0, 0), row_step=(0, 2, 0), pixels=(64, 48))
scene.beam = sk.Beam.mono(60, 1000)
poses = np.stack([sk.translate(x, 0, 0) for x in range(8)])
image = scene.image("transmission")

# Out by DLPack: the consumer sees the same memory. np.from_dlpack stands for torch.from_dlpack and the like.
shared = np.from_dlpack(image)
assert np.shares_memory(shared, image)

# Out by the buffer protocol, for everything that takes bytes.
assert memoryview(image).shape == (48, 64)

# In: the library writes into memory that another library owns, here every second image of a larger array.
batch = np.zeros((16, 48, 64), np.float32)
scene.images("transmission", poses={"ball": poses}, out=batch[::2])
assert (batch[0] == image).all() and not batch[1].any()

try:
    import torch
except ImportError:
    print("no PyTorch")
else:
    tensor = torch.from_dlpack(image)  # no copy
    mine = torch.empty((8, 48, 64))  # pin_memory=True where there is CUDA
    scene.images("transmission", poses={"ball": poses}, out=mine)  # no copy
    assert tensor.data_ptr() == image.__array_interface__["data"][0] and bool((mine[0] == tensor).all())
    if torch.cuda.is_available():
        print("on the GPU:", tensor.to("cuda").mean().item())

try:
    import cupy
except ImportError:
    print("no CuPy")
else:
    print("on the GPU:", float(cupy.asarray(image).mean()))  # one copy

print(f"mean transmission {image.mean():.4f}")
