/** Portuguese descriptions, limits of validity and sources of the values of scenarios, coil systems, studies and experiments. */
import { bench } from './schema/bench';
import { coils } from './schema/coils';
import { control } from './schema/control';
import { files } from './schema/files';
import { optics } from './schema/optics';
import { scene } from './schema/scene';
import { studies } from './schema/studies';
import { swarm } from './schema/swarm';

export const schema: Record<string, string> = { ...scene, ...coils, ...swarm, ...control, ...files, ...bench, ...studies, ...optics };
