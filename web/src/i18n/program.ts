import type { Language } from '.';
import { jobTexts } from './job_texts';

/** Translations of fixed texts of the program: sections of a scenario, verbs, steps of a job, messages of the server. */
export const kProgram: Record<Language, Record<string, string>> = {
  en: {},
  pt: {
    ...jobTexts,
    swarm: 'enxame', model: 'modelo', start: 'posições iniciais', controller: 'controlador', reference: 'referência', estimator: 'estimador', field: 'campo', motility: 'motilidade', scale: 'escala', camera: 'câmera',
    limits: 'limites', exclusion: 'exclusão', simulation: 'simulação', record: 'gravação', microscope: 'microscópio', flow: 'fluxo óptico', rig: 'bancada', library: 'biblioteca', coil: 'bobina', segment: 'segmento',
    activity: 'atividade', compare: 'comparação', identify: 'identificação', 'compare-controllers': 'comparação de controladores', 'field map': 'mapa do campo', track: 'rastreamento', moving: 'em movimento', still: 'parada', drifting: 'à deriva',
    calibration: 'calibração', typed: 'digitada', metadata: 'metadados',
    simulating: 'simulando', 'simulating with another seed': 'simulando com outra semente', measuring: 'medindo', tracking: 'rastreando', trials: 'ensaios', capturing: 'capturando', replaying: 'reproduzindo',
    'another page is steering; take control first': 'outra página controla o enxame; assuma antes o controle',
    'no run; start a scenario first': 'nenhuma execução; inicie antes um cenário',
    'no camera is open': 'nenhuma câmera está aberta',
    'no image from the camera': 'não há imagem da câmera',
    'camera: no more pictures; this is the last one': 'câmera: não há mais imagens; esta é a última',
    'a value has the wrong type': 'um valor tem o tipo errado',
    'file not found': 'arquivo não encontrado',
    'file not found in the folder in which the lab was started': 'arquivo não encontrado na pasta em que o laboratório foi iniciado',
    'is outside the folder in which the lab was started': 'está fora da pasta em que o laboratório foi iniciado',
    'scene not found': 'cena não encontrada',
    'not found': 'não encontrado',
    'job not found': 'tarefa não encontrada',
    'missing; it must be a non-empty string': 'falta; deve ser um texto não vazio',
    'the run has no tracks.h5; only its video can be displayed': 'a gravação não tem tracks.h5; só o vídeo pode ser mostrado',
  },
};
