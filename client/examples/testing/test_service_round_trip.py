"""A test of round trips with the real service, to be copied into a project of your own.

buoyancyd is searched for in $PATH; the environment variable BUOYANCYD names another one.
"""
import buoyancy

# A crate of 1 m^3 in fresh water.
SCENE = """
[water]
density = 1000.0
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 1] }
"""


def test_crate_floats_at_half_its_height(buoyancy_service):
    service = buoyancy_service(scene_text=SCENE)
    with buoyancy.Client(lcm_url=service.lcm_url) as client:
        wrench = client.request(1, position=(0, 0, 0), quaternion=(1, 0, 0, 0))
    assert abs(wrench.force[2] - 500.0 * 9.80665) <= wrench.force_error_bound


def test_lost_responses_change_nothing(buoyancy_service):
    service = buoyancy_service(scene_text=SCENE, arguments=["--inject", "drop=0.3,corrupt=0.1,duplicate=0.2,seed=7"])
    with buoyancy.Client(lcm_url=service.lcm_url, timeout=0.02, max_retries=500) as client:
        for step in range(50):
            wrench = client.request(1, position=(0, 0, 0), quaternion=(1, 0, 0, 0), time=0.01 * step)
            assert abs(wrench.force[2] - 500.0 * 9.80665) <= wrench.force_error_bound
        assert client.statistics["retries"] > 0
