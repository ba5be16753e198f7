"""What buoyancy-import consists of, one job a module; buoyancy.import_model is the program.

    xml_file       reads XML within limits and without entities
    file_search    finds the files that a model names
    frames         poses, rotations, 6 x 6 matrices
    model          what every format is read into: links, joints, geometry, plugins
    sdf, urdf, mjcf
                   read one format each
    bodies         which links become a body, and in which frame
    geometry       volumes of shapes and meshes, meshes of shapes that a scene lacks
    mass           sums masses and inertias
    hydrodynamics  a table of plugins, and what each becomes
    scene_toml     writes the scene, a comment with each value, and the report

docs/importing.md describes what is converted, and how.
"""
