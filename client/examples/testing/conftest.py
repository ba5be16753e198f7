pytest_plugins = ["buoyancy.testing"]
